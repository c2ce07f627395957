#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/steady_timer.hpp>

namespace atlaswire::server {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;

}  // namespace atlaswire::server
