#include "server/udp_port.h"

#include <fmt/format.h>
#include <netinet/in.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace atlaswire::server {

proto::PeerAddress to_peer(const sockaddr_storage& address) {
  proto::PeerAddress peer;
  if (address.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &address, sizeof(v4));
    std::array<std::uint8_t, 4> ip{};
    std::memcpy(ip.data(), &v4.sin_addr, ip.size());
    return proto::ipv4_address(ip, ntohs(v4.sin_port));
  }
  sockaddr_in6 v6{};
  std::memcpy(&v6, &address, sizeof(v6));
  std::memcpy(peer.ip.data(), &v6.sin6_addr, peer.ip.size());
  peer.port = ntohs(v6.sin6_port);
  return peer;
}

socklen_t to_sockaddr(const proto::PeerAddress& peer, bool v6, sockaddr_storage& out) {
  out = {};
  if (v6) {
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_port = htons(peer.port);
    std::memcpy(&address.sin6_addr, peer.ip.data(), peer.ip.size());
    std::memcpy(&out, &address, sizeof(address));
    return sizeof(address);
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(peer.port);
  std::memcpy(&address.sin_addr, peer.ip.data() + 12, 4);
  std::memcpy(&out, &address, sizeof(address));
  return sizeof(address);
}

std::string to_text(const proto::PeerAddress& peer) {
  const auto v6 = asio::ip::address_v6(peer.ip);
  if (v6.is_v4_mapped()) {
    return fmt::format("{}:{}", asio::ip::make_address_v4(asio::ip::v4_mapped, v6).to_string(), peer.port);
  }
  return fmt::format("[{}]:{}", v6.to_string(), peer.port);
}

UdpPort::UdpPort(udp::socket socket, OnDatagram on_datagram, OnBatch on_batch, OnBatch on_writable)
    : socket_(std::move(socket)),
      v6_(socket_.local_endpoint().address().is_v6()),
      on_datagram_(std::move(on_datagram)),
      on_batch_(std::move(on_batch)),
      on_writable_(std::move(on_writable)),
      buffers_(std::make_unique<Buffers>()) {
  socket_.non_blocking(true);
  boost::system::error_code ignored;
  socket_.set_option(asio::socket_base::receive_buffer_size(4 << 20), ignored);
  socket_.set_option(asio::socket_base::send_buffer_size(4 << 20), ignored);
  for (std::size_t i = 0; i < kBatch; ++i) {
    buffers_->parts[i] = {buffers_->octets[i].data(), buffers_->octets[i].size()};
  }
}

void UdpPort::start() { wait_readable(); }

void UdpPort::close() {
  boost::system::error_code ignored;
  socket_.close(ignored);
}

void UdpPort::wait_readable() {
  socket_.async_wait(udp::socket::wait_read, [this](const boost::system::error_code& e) {
    if (e) return;
    read_turn();
    if (socket_.is_open()) wait_readable();
  });
}

void UdpPort::read_turn() {
  for (std::size_t i = 0; i < kBatchesPerTurn; ++i) {
    if (read_batch() < static_cast<int>(kBatch)) break;
  }
  on_batch_();
}

int UdpPort::read_batch() {
  for (std::size_t i = 0; i < kBatch; ++i) {
    msghdr header{};
    header.msg_name = &buffers_->from[i];
    header.msg_namelen = sizeof(sockaddr_storage);
    header.msg_iov = &buffers_->parts[i];
    header.msg_iovlen = 1;
    buffers_->messages[i] = {header, 0};
  }
  const int count =
      ::recvmmsg(socket_.native_handle(), buffers_->messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    on_datagram_(to_peer(buffers_->from[at]),
                 ByteView(buffers_->octets[at].data(), buffers_->messages[at].msg_len));
  }
  return count;
}

void UdpPort::send(const proto::PeerAddress& to, ByteView datagram) {
  if (try_send(to, datagram)) return;
  pending_to_ = to;
  pending_.assign(datagram.begin(), datagram.end());
  wait_writable();
}

bool UdpPort::try_send(const proto::PeerAddress& to, ByteView datagram) {
  sockaddr_storage address{};
  const socklen_t size = to_sockaddr(to, v6_, address);
  const auto sent = ::sendto(socket_.native_handle(), datagram.data(), datagram.size(), MSG_DONTWAIT,
                             reinterpret_cast<const sockaddr*>(&address), size);
  return sent >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
}

void UdpPort::wait_writable() {
  socket_.async_wait(udp::socket::wait_write, [this](const boost::system::error_code& e) {
    if (e) return;
    if (!try_send(pending_to_, pending_)) return wait_writable();
    pending_.clear();
    on_writable_();
  });
}

}  // namespace atlaswire::server
