#include "tests/netsim/loopback.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

namespace atlaswire::netsim {

namespace {

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

constexpr std::chrono::milliseconds kPoll{50};

}  // namespace

LoopbackSocket::LoopbackSocket(Kind kind)
    : fd_(::socket(AF_INET, (kind == Kind::kUdp ? SOCK_DGRAM : SOCK_STREAM) | SOCK_CLOEXEC, 0)) {
  limit_waiting(std::chrono::seconds(20));
  const int large = 4 << 20;
  const int yes = 1;
  if (kind == Kind::kTcp) return;
  setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &large, sizeof large);
  setsockopt(fd_, IPPROTO_IP, IP_RECVTOS, &yes, sizeof yes);
}

LoopbackSocket::~LoopbackSocket() {
  if (fd_ >= 0) ::close(fd_);
}

bool LoopbackSocket::connect(std::uint16_t port) const {
  const sockaddr_in to = loopback(port);
  return ::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
}

std::uint16_t LoopbackSocket::bind_and_listen(Kind kind, std::uint16_t port) const {
  sockaddr_in at = loopback(port);
  socklen_t size = sizeof at;
  auto* address = reinterpret_cast<sockaddr*>(&at);
  if (::bind(fd_, address, size) != 0 || (kind == Kind::kTcp && ::listen(fd_, 16) != 0)) return 0;
  ::getsockname(fd_, address, &size);
  return ntohs(at.sin_port);
}

bool LoopbackSocket::send(ByteView octets) const {
  do {  // an empty datagram is one too
    const ssize_t sent = ::send(fd_, octets.data(), octets.size(), MSG_NOSIGNAL);
    if (sent < 0) return false;
    octets = octets.subspan(static_cast<std::size_t>(sent));
  } while (!octets.empty());
  return true;
}

std::optional<ByteBuffer> LoopbackSocket::receive() const {
  ByteBuffer buffer(65'536);
  const ssize_t size = ::recv(fd_, buffer.data(), buffer.size(), 0);
  if (size < 0) return std::nullopt;
  buffer.resize(static_cast<std::size_t>(size));
  return buffer;
}

void LoopbackSocket::send_with_ecn(int bits) const {
  setsockopt(fd_, IPPROTO_IP, IP_TOS, &bits, sizeof bits);
}

std::optional<LoopbackSocket::Received> LoopbackSocket::receive_with_ecn() const {
  Received r{ByteBuffer(65'536), 0, {}};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
  iovec part{r.octets.data(), r.octets.size()};
  msghdr message{};
  message.msg_name = &r.from;
  message.msg_namelen = sizeof r.from;
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = ::recvmsg(fd_, &message, 0);
  if (size < 0) return std::nullopt;
  r.octets.resize(static_cast<std::size_t>(size));
  if (cmsghdr* first = CMSG_FIRSTHDR(&message)) r.ecn = *CMSG_DATA(first) & 3;
  return r;
}

void LoopbackSocket::limit_waiting(std::chrono::milliseconds limit) const {
  const timeval time{.tv_sec = limit.count() / 1000, .tv_usec = limit.count() % 1000 * 1000};
  setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
}

void LoopbackSocket::end_sending() const { ::shutdown(fd_, SHUT_WR); }

void LoopbackSocket::reset() {
  const linger hard{.l_onoff = 1, .l_linger = 0};
  setsockopt(fd_, SOL_SOCKET, SO_LINGER, &hard, sizeof hard);
  ::close(std::exchange(fd_, -1));
}

EchoServer::EchoServer() : udp_(LoopbackSocket::Kind::kUdp), tcp_(LoopbackSocket::Kind::kTcp) {
  port_ = tcp_.bind_and_listen(LoopbackSocket::Kind::kTcp);
  if (udp_.bind_and_listen(LoopbackSocket::Kind::kUdp, port_) == 0) port_ = 0;
  udp_.limit_waiting(kPoll);
  tcp_.limit_waiting(kPoll);
  datagrams_ = std::thread([this] { echo_datagrams(); });
  streams_ = std::thread([this] { echo_streams(); });
}

EchoServer::~EchoServer() {
  stopping_ = true;
  datagrams_.join();
  streams_.join();
}

void EchoServer::echo_datagrams() {
  while (!stopping_) {
    const auto got = udp_.receive_with_ecn();
    if (!got) continue;
    udp_.send_with_ecn(got->ecn);
    const auto* to = reinterpret_cast<const sockaddr*>(&got->from);
    ::sendto(udp_.fd(), got->octets.data(), got->octets.size(), 0, to, sizeof got->from);
  }
}

/// One connection at a time.
void EchoServer::echo_streams() {
  while (!stopping_) {
    const int fd = ::accept(tcp_.fd(), nullptr, nullptr);
    if (fd < 0) continue;
    const LoopbackSocket peer(fd);
    peer.limit_waiting(kPoll);
    while (!stopping_) {
      const auto octets = peer.receive();
      if (!octets && (errno == EAGAIN || errno == EWOULDBLOCK)) continue;
      if (!octets) ++resets_;
      if (!octets || octets->empty() || !peer.send(*octets)) break;
    }
  }
}

std::pair<int, std::string> run_command(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return {-1, "cannot run"};
  std::string output;
  char buffer[4096];
  while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, size);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

}  // namespace atlaswire::netsim
