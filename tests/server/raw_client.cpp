#include "tests/server/raw_client.h"

#include "proto/datagram.h"
#include "proto/rtcp.h"
#include "proto/rtp.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace atlaswire::server {

using namespace std::chrono_literals;

RawSocket::RawSocket(int type, std::uint16_t port) : fd_(::socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    ::close(fd_);
    throw std::runtime_error("cannot connect to the daemon");
  }
  ::fcntl(fd_, F_SETFL, O_NONBLOCK);
}

RawSocket::~RawSocket() { ::close(fd_); }

bool RawSocket::send(ByteView bytes) {
  return ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

ByteBuffer RawSocket::receive() {
  ByteBuffer buffer(65536);
  const auto count = ::recv(fd_, buffer.data(), buffer.size(), 0);
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK)) ended_ = true;
  buffer.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return buffer;
}

bool RawSocket::wait(Duration timeout) const {
  pollfd entry{fd_, POLLIN, 0};
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout).count();
  return ::poll(&entry, 1, static_cast<int>(ms)) > 0;
}

RawClient::RawClient(std::uint16_t port, const proto::ClientHello& hello)
    : tcp_(SOCK_STREAM, port), udp_(SOCK_DGRAM, port) {
  send(hello);
}

void RawClient::send(const proto::Message& message) {
  ByteBuffer bytes;
  proto::append_message(message, bytes);
  tcp_.send(bytes);
}

bool RawClient::run_until(const std::function<bool()>& done, Duration timeout) {
  const Time end = steady_now() + timeout;
  while (!done()) {
    const Time now = steady_now();
    if (now >= end || (tcp_.ended() && !done())) return done();
    send_due(now);
    std::array<pollfd, 2> entries{{{tcp_.fd(), POLLIN, 0}, {udp_.fd(), POLLIN, 0}}};
    ::poll(entries.data(), entries.size(), 10);
    if (entries[0].revents != 0) read_stream();
    if (entries[1].revents != 0) read_datagrams();
  }
  return true;
}

void RawClient::read_stream() {
  reader_.feed(tcp_.receive());
  for (auto next = reader_.next(); next && *next; next = reader_.next()) {
    const auto message = proto::parse_message(**next).value();
    if (const auto* hello = std::get_if<proto::ServerHello>(&message)) {
      hello_ = *hello;
      poses_.emplace(hello->session);
    }
    if (const auto* refusal = std::get_if<proto::Refusal>(&message)) refusal_ = *refusal;
    if (const auto* goodbye = std::get_if<proto::Goodbye>(&message)) goodbye_ = *goodbye;
    if (const auto* meta = std::get_if<proto::FrameMeta>(&message)) metas_.push_back(*meta);
  }
}

void RawClient::read_datagrams() {
  for (auto datagram = udp_.receive(); !datagram.empty(); datagram = udp_.receive()) {
    const auto kind = proto::classify(datagram);
    if (kind == proto::DatagramKind::kChallenge && hello_) {
      const auto challenge = proto::parse_challenge(datagram).value();
      ByteBuffer out;
      encode(proto::Confirm{hello_->session, hello_->udp_token, challenge.nonce}, out);
      udp_.send(out);
      proven_ = true;
    } else if (kind == proto::DatagramKind::kRtp) {
      const auto packet = proto::parse_rtp(datagram).value();
      ++packets_;
      if (packet.header.marker) pictures_.insert(*packet.header.extensions.frame);
    }
  }
}

void RawClient::send_due(Time now) {
  if (!hello_ || now < next_pose_) return;
  next_pose_ = now + 20ms;
  ByteBuffer out;
  if (!proven_) {
    encode(proto::Probe{hello_->session, hello_->udp_token}, out);
  } else {
    Pose pose;
    pose.position = {0.0, 1.7, 0.0};
    poses_->push(pose, now);
    encode(poses_->packet(), out);
  }
  udp_.send(out);
}

void RawClient::lose_picture() {
  ByteBuffer out;
  const std::array<proto::RtcpPacket, 2> packets{proto::ReceiverReport{1, {}},
                                                 proto::PictureLoss{1, hello_->stream.ssrc}};
  proto::encode_rtcp(packets, out);
  udp_.send(out);
}

std::size_t RawClient::paired() const {
  return static_cast<std::size_t>(
      std::count_if(metas_.begin(), metas_.end(),
                    [&](const proto::FrameMeta& meta) { return pictures_.contains(meta.frame); }));
}

}  // namespace atlaswire::server
