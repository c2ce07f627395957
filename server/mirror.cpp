#include "server/mirror.h"

#include "base/program.h"
#include "proto/sdp.h"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>

namespace atlaswire::server {

namespace {

udp::endpoint resolve(asio::io_context& io, const HostPort& settings) {
  boost::system::error_code e;
  udp::resolver resolver(io);
  const auto found = resolver.resolve(settings.host, std::to_string(settings.port), e);
  if (e || found.empty()) {
    throw ProgramError(ExitCode::kUsage, fmt::format("--mirror {}:{}: cannot resolve the host: {}",
                                                     settings.host, settings.port, e.message()));
  }
  return *found.begin();
}

}  // namespace

Mirror::Mirror(asio::io_context& io, const HostPort& settings)
    : to_(resolve(io, settings)), socket_(io, to_.protocol()) {
  socket_.non_blocking(true);
  boost::system::error_code ignored;
  socket_.set_option(asio::socket_base::send_buffer_size(1 << 20), ignored);
}

void Mirror::send(ByteView datagram) {
  boost::system::error_code lost;
  socket_.send_to(asio::buffer(datagram.data(), datagram.size()), to_, 0, lost);
}

std::string mirror_sdp(const HostPort& mirror, const std::string& scene, const ByteBuffer& parameter_sets) {
  asio::io_context io;
  proto::SdpSettings sdp;
  sdp.session_name = "atlaswire " + scene;
  sdp.address = resolve(io, mirror).address().to_string();
  sdp.port = mirror.port;
  sdp.parameter_sets = parameter_sets;
  return proto::make_sdp(sdp);
}

}  // namespace atlaswire::server
