#include "netsim/relay_socket.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <boost/asio/io_context.hpp>

namespace atlaswire::netsim {
namespace {

using boost::asio::ip::udp;

/// Every code point from a socket at `from` to one at `to` and back.
void send_both_ways(const char* from, const char* to) {
  boost::asio::io_context io;
  boost::system::error_code e;
  const auto open = [&](const char* address) {
    const udp::endpoint at(boost::asio::ip::make_address(address), 0);
    udp::socket socket(io);
    socket.open(at.protocol(), e);
    if (!e) socket.bind(at, e);
    return socket;
  };
  udp::socket near = open(from);
  udp::socket far = open(to);
  if (e) GTEST_SKIP() << to << ": " << e.message();
  udp::endpoint far_end = far.local_endpoint();
  if (far_end.address().is_unspecified())
    far_end = {boost::asio::ip::make_address("127.0.0.1"), far_end.port()};
  near.connect(far_end);
  RelaySocket client(std::move(near));
  RelaySocket server(std::move(far));
  const auto receive = [&](RelaySocket& socket, udp::endpoint& sender) {
    pollfd waiting{socket.socket().native_handle(), POLLIN, 0};
    EXPECT_EQ(::poll(&waiting, 1, 20'000), 1);
    std::byte buffer[16];
    Ecn ecn{};
    EXPECT_EQ(socket.receive(buffer, sender, ecn, e), 3U) << e.message();
    return ecn;
  };
  for (const Ecn ecn : {Ecn::kNotCapable, Ecn::kCapable1, Ecn::kCapable0, Ecn::kCongestion}) {
    udp::endpoint sender;
    client.send(ByteBuffer(3), far_end, ecn, e);
    EXPECT_FALSE(e) << e.message();
    EXPECT_EQ(receive(server, sender), ecn);
    server.send(ByteBuffer(3), sender, ecn, e);
    EXPECT_FALSE(e) << e.message();
    EXPECT_EQ(receive(client, sender), ecn);
  }
  udp::endpoint nobody;
  std::byte buffer[16];
  Ecn ecn{};
  client.receive(buffer, nobody, ecn, e);
  EXPECT_EQ(e, boost::asio::error::would_block);
}

TEST(RelaySocket, KeepsTheBitsOverIpv4) { send_both_ways("127.0.0.1", "127.0.0.1"); }
TEST(RelaySocket, KeepsTheBitsOverIpv6) { send_both_ways("::1", "::1"); }
TEST(RelaySocket, KeepsTheBitsOfIpv4OnAnIpv6Socket) { send_both_ways("127.0.0.1", "::"); }

}  // namespace
}  // namespace atlaswire::netsim
