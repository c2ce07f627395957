#include "netsim/relay_socket.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace atlaswire::netsim {

namespace {

constexpr int kSocketBuffer = 4 * 1024 * 1024;
constexpr unsigned kEcnBits = 3;

/// Room for one control message of an int.
struct Control {
  alignas(cmsghdr) char octets[CMSG_SPACE(sizeof(int))];
};

boost::system::error_code last_error() { return {errno, boost::system::system_category()}; }

/// IPv4 gives one octet, IPv6 an int.
unsigned traffic_class(cmsghdr* message) {
  if (message->cmsg_level == IPPROTO_IP && message->cmsg_type == IP_TOS) return *CMSG_DATA(message);
  int value = 0;
  if (message->cmsg_level == IPPROTO_IPV6 && message->cmsg_type == IPV6_TCLASS)
    std::memcpy(&value, CMSG_DATA(message), sizeof value);
  return static_cast<unsigned>(value);
}

bool is_v4(const boost::asio::ip::address& address) {
  return address.is_v4() || address.to_v6().is_v4_mapped();
}

}  // namespace

RelaySocket::RelaySocket(boost::asio::ip::udp::socket socket) : socket_(std::move(socket)) {
  boost::system::error_code none;
  socket_.remote_endpoint(none);
  connected_ = !none;
  boost::system::error_code ignored;  // smaller buffers only lose earlier
  socket_.set_option(boost::asio::socket_base::receive_buffer_size(kSocketBuffer), ignored);
  socket_.set_option(boost::asio::socket_base::send_buffer_size(kSocketBuffer), ignored);
  socket_.non_blocking(true);
  const int yes = 1;  // an IPv6 socket carries IPv4 too, and one of IPv4 refuses the second option
  setsockopt(socket_.native_handle(), IPPROTO_IP, IP_RECVTOS, &yes, sizeof yes);
  setsockopt(socket_.native_handle(), IPPROTO_IPV6, IPV6_RECVTCLASS, &yes, sizeof yes);
}

std::size_t RelaySocket::receive(std::span<std::byte> buffer, Endpoint& from, Ecn& ecn,
                                 boost::system::error_code& e) {
  Control control;
  iovec part{buffer.data(), buffer.size()};
  msghdr message{};
  message.msg_name = from.data();
  message.msg_namelen = static_cast<socklen_t>(from.capacity());
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.octets;
  message.msg_controllen = sizeof control.octets;
  const ssize_t size = ::recvmsg(socket_.native_handle(), &message, 0);
  e = size < 0 ? last_error() : boost::system::error_code{};
  ecn = Ecn::kNotCapable;
  if (size < 0) return 0;
  from.resize(message.msg_namelen);
  if (cmsghdr* first = CMSG_FIRSTHDR(&message)) ecn = static_cast<Ecn>(traffic_class(first) & kEcnBits);
  return static_cast<std::size_t>(size);
}

void RelaySocket::send(ByteView octets, const Endpoint& to, Ecn ecn, boost::system::error_code& e) {
  Control control{};
  iovec part{const_cast<std::byte*>(octets.data()), octets.size()};
  msghdr message{};
  if (!connected_) {
    message.msg_name = const_cast<sockaddr*>(to.data());
    message.msg_namelen = static_cast<socklen_t>(to.size());
  }
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  if (ecn != Ecn::kNotCapable) {
    message.msg_control = control.octets;
    message.msg_controllen = sizeof control.octets;
    cmsghdr* tos = CMSG_FIRSTHDR(&message);
    const bool v4 = is_v4(to.address());
    const int value = static_cast<int>(ecn);
    tos->cmsg_level = v4 ? IPPROTO_IP : IPPROTO_IPV6;
    tos->cmsg_type = v4 ? IP_TOS : IPV6_TCLASS;
    tos->cmsg_len = CMSG_LEN(sizeof value);
    std::memcpy(CMSG_DATA(tos), &value, sizeof value);
  }
  e = ::sendmsg(socket_.native_handle(), &message, MSG_NOSIGNAL) < 0 ? last_error()
                                                                     : boost::system::error_code{};
}

}  // namespace atlaswire::netsim
