#include "client/network_thread.h"

#include "proto/datagram.h"
#include "proto/framing.h"
#include "proto/messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>

namespace atlaswire::client {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using ::testing::HasSubstr;

/// A TCP and UDP socket of one free port on the loopback, driven step by step by the test.
struct Listener {
  asio::io_context io;
  tcp::acceptor acceptor{io, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  udp::socket datagrams{io,
                        udp::endpoint(asio::ip::address_v4::loopback(), acceptor.local_endpoint().port())};

  [[nodiscard]] HostPort endpoint() const { return {"127.0.0.1", acceptor.local_endpoint().port()}; }
};

NetworkSettings settings_for(const HostPort& server) {
  NetworkSettings s{.server = server};
  s.sample_pose = [](Time) { return std::optional(Pose{}); };
  return s;
}

bool never() { return false; }

proto::Message read_message(tcp::socket& socket, proto::FrameReader& reader) {
  while (true) {
    auto frame = reader.next();
    if (*frame) return proto::parse_message(**frame).value();
    std::array<std::byte, 4096> bytes;
    const std::size_t count = socket.read_some(asio::buffer(bytes));
    reader.feed(ByteView(bytes).first(count));
  }
}

void write_message(tcp::socket& socket, const proto::Message& message) {
  ByteBuffer bytes;
  proto::append_message(message, bytes);
  asio::write(socket, asio::buffer(bytes));
}

proto::ServerHello some_answer() {
  proto::ServerHello answer{.version = 1, .session = SessionId{7}, .udp_token = {}, .stream = {}};
  answer.stream.picture = {64, 64};
  answer.stream.atlas = {64, 64};
  return answer;
}

TEST(NetworkThread, SaysThatNobodyListens) {
  HostPort server;
  {
    const Listener gone;
    server = gone.endpoint();
  }
  ArrivalQueue arrivals(kArrivalPlaces);
  NetworkThread network(settings_for(server), arrivals);
  EXPECT_FALSE(network.wait_for_answer(never));
  ASSERT_TRUE(network.end());
  EXPECT_EQ(exit_code(network.end()->kind), ExitCode::kCannotConnect);
  EXPECT_THAT(network.end()->text, HasSubstr("127.0.0.1:" + std::to_string(server.port)));
  EXPECT_THAT(network.end()->text, HasSubstr("start atlasd"));
  EXPECT_FALSE(arrivals.pop()) << "the queue is closed, so that nobody waits";
}

TEST(NetworkThread, NamesAHostThatDoesNotExist) {
  ArrivalQueue arrivals(kArrivalPlaces);
  NetworkThread network(settings_for({"no-such-host.invalid", 7400}), arrivals);
  EXPECT_FALSE(network.wait_for_answer(never));
  EXPECT_THAT(network.end()->text, HasSubstr("no-such-host.invalid"));
}

TEST(NetworkThread, CarriesTheHandshakeProbesAndTheGoodbye) {
  Listener listener;
  ArrivalQueue arrivals(kArrivalPlaces);
  NetworkThread network(settings_for(listener.endpoint()), arrivals);
  tcp::socket peer = listener.acceptor.accept();
  proto::FrameReader reader(proto::kMaxEnvelope);
  EXPECT_TRUE(std::holds_alternative<proto::ClientHello>(read_message(peer, reader)));
  write_message(peer, some_answer());
  const auto answer = network.wait_for_answer(never);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->session, SessionId{7});

  std::array<std::byte, 2000> bytes;
  udp::endpoint from;
  bool probed = false;
  bool posed = false;
  while (!probed || !posed) {
    const std::size_t count = listener.datagrams.receive_from(asio::buffer(bytes), from);
    const auto kind = proto::classify(ByteView(bytes).first(count));
    probed = probed || kind == proto::DatagramKind::kProbe;
    posed = posed || kind == proto::DatagramKind::kPose;
  }
  proto::FrameMeta meta;
  meta.frame = FrameId{3};
  write_message(peer, meta);
  const auto arrival = arrivals.pop();
  ASSERT_TRUE(arrival && arrival->update);
  EXPECT_EQ(arrival->update->update.meta.frame, FrameId{3});

  network.finish();
  EXPECT_TRUE(std::holds_alternative<proto::Goodbye>(read_message(peer, reader)));
  EXPECT_EQ(network.end()->kind, SessionEnd::Kind::kFinished);
  EXPECT_EQ(network.snapshot().updates, 1U);
}

TEST(NetworkThread, NoticesAServerThatDies) {
  ArrivalQueue arrivals(kArrivalPlaces);
  std::optional<NetworkThread> network;
  {
    Listener listener;
    network.emplace(settings_for(listener.endpoint()), arrivals);
    tcp::socket peer = listener.acceptor.accept();
    proto::FrameReader reader(proto::kMaxEnvelope);
    read_message(peer, reader);
    write_message(peer, some_answer());
    ASSERT_TRUE(network->wait_for_answer(never));
  }
  while (arrivals.pop()) {
  }
  ASSERT_TRUE(network->end());
  EXPECT_EQ(exit_code(network->end()->kind), ExitCode::kPeerLost);
}

TEST(NetworkThread, CanBeDestroyedAtAnyTime) {
  Listener listener;
  ArrivalQueue arrivals(kArrivalPlaces);
  { const NetworkThread network(settings_for(listener.endpoint()), arrivals); }
  NetworkThread network(settings_for(listener.endpoint()), arrivals);
  tcp::socket peer = listener.acceptor.accept();
  EXPECT_FALSE(network.wait_for_answer([] { return true; }));
  network.finish();
}

}  // namespace
}  // namespace atlaswire::client
