#include "server/connection.h"

#include "server/secure_random.h"
#include "server/udp_port.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <utility>

namespace atlaswire::server {

namespace {

using namespace std::chrono_literals;

/// The pacer may catch up this much: finer timers would only cost wake-ups.
constexpr Duration kTimerGrain = 1ms;

std::string text_of(const tcp::endpoint& endpoint) {
  return fmt::format("{}:{}", endpoint.address().to_string(), endpoint.port());
}

tcp::endpoint remote_of(const tcp::socket& socket) {
  boost::system::error_code gone;
  return socket.remote_endpoint(gone);
}

}  // namespace

Connection::Connection(ConnectionHost& host, tcp::socket socket, const SessionSettings& settings,
                       const SessionKeys& keys)
    : host_(host),
      socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      peer_address_(remote_of(socket_).address()),
      peer_(text_of(remote_of(socket_))),
      session_(settings, keys, random_nonce, steady_now()) {
  boost::system::error_code ignored;
  socket_.set_option(tcp::no_delay(true), ignored);
}

Connection::~Connection() {
  // After finish() there is none, and the host may be gone.
  if (runner_) host_.end_stream(std::move(runner_));
}

void Connection::start() {
  read();
  pump();
}

void Connection::read() {
  if (reading_ || finished_) return;
  reading_ = true;
  socket_.async_read_some(asio::buffer(input_), [self = shared_from_this()](
                                                    const boost::system::error_code& e, std::size_t count) {
    self->reading_ = false;
    const Time now = steady_now();
    if (e) {
      self->session_.on_stream_end(e == asio::error::eof ? "connection closed by the client" : e.message(),
                                   now);
    } else {
      self->session_.on_stream_bytes(ByteView(self->input_).first(count), now);
      self->read();
    }
    self->pump();
  });
}

void Connection::write() {
  if (writing_ || finished_ || session_.stream_output().empty()) return;
  writing_ = true;
  const ByteView out = session_.stream_output();
  socket_.async_write_some(
      asio::buffer(out.data(), out.size()),
      [self = shared_from_this()](const boost::system::error_code& e, std::size_t count) {
        self->writing_ = false;
        if (self->finished_) return;
        const Time now = steady_now();
        if (e) {
          self->session_.on_stream_end(fmt::format("connection lost ({})", e.message()), now);
        } else {
          self->session_.stream_sent(count, now);
        }
        self->pump();
      });
}

void Connection::on_datagram(const proto::PeerAddress& from, ByteView datagram, Time now) {
  if (finished_) return;
  session_.on_datagram(from, datagram, now);
  needs_pump_ = true;
}

void Connection::on_frame(const FramePtr& frame) {
  if (finished_ || !runner_) return;
  session_.deliver(frame, steady_now());
  runner_->frame_taken();
  pump();
}

void Connection::on_stream_failure(const std::string& reason) {
  close(proto::Goodbye::Reason::kInternal, reason);
}

void Connection::close(proto::Goodbye::Reason reason, const std::string& text) {
  if (finished_) return;
  session_.close(reason, text, steady_now());
  pump();
}

void Connection::on_emphasis() {
  if (runner_) runner_->set_emphasis(over(wish_, host_.emphasis()));
}

bool Connection::request_layout() {
  if (runner_) runner_->request_layout();
  return runner_ != nullptr;
}

void Connection::abort(const std::string& reason) {
  if (finished_) return;
  session_.on_stream_end(reason, steady_now());
  pump();
}

void Connection::pump() {
  needs_pump_ = false;
  if (finished_) return;
  const Time now = steady_now();
  session_.poll(now);
  if (session_.state() == SessionState::kHelloReceived) answer_hello(now);
  if (session_.state() == SessionState::kStreaming) steer_stream();
  if (session_.state() >= SessionState::kClosing && runner_) host_.end_stream(std::move(runner_));
  send_datagrams(now);
  for (const Departure& departure : session_.take_departures()) {
    if (runner_ && !departure.dropped)
      runner_->frame_left(departure.left - departure.frame->stamps.encode_end);
    host_.on_departure(*this, departure);
  }
  if (session_.state() == SessionState::kClosed) return finish();
  write();
  arm_timer(now);
}

void Connection::answer_hello(Time now) {
  if (const auto refusal = host_.admit(*this)) return session_.refuse(*refusal, now);
  session_.accept(host_.description(), now);
}

void Connection::steer_stream() {
  if (session_.media_address() != known_address_) {
    known_address_ = session_.media_address();
    host_.on_address(*this, *known_address_);
  }
  if (!runner_) {
    try {
      runner_ = host_.start_stream(*this);
    } catch (const std::exception& e) {  // no thread to be had
      return close(proto::Goodbye::Reason::kInternal, e.what());
    }
  }
  const auto& pose = session_.newest_pose();
  if (pose && pose->stamped.id != last_pose_) {
    last_pose_ = pose->stamped.id;
    runner_->set_view(pose->stamped, pose->received, session_.round_trip());
  }
  if (auto wish = session_.take_emphasis()) {
    wish_ = *std::move(wish);
    on_emphasis();
  }
  if (session_.take_refresh_request()) runner_->request_refresh();
  if (const auto why = session_.take_restart_request(steady_now())) {
    spdlog::warn("session {}: the client is out of step, all is told anew: {}", value(session_.id()), *why);
    runner_->request_restart();
  }
  runner_->set_paused(session_.is_congested());
}

void Connection::send_datagrams(Time now) {
  while (host_.can_send()) {
    const auto datagram = session_.next_datagram(now);
    if (!datagram) return;
    host_.send(*this, *datagram);
  }
}

void Connection::arm_timer(Time now) {
  auto due = session_.next_deadline();
  // While the socket is full its owner wakes us.
  if (!due || !host_.can_send()) return;
  due = std::max(*due, now + kTimerGrain);
  if (armed_for_ && *armed_for_ <= *due && *armed_for_ > now) return;
  armed_for_ = due;
  timer_.expires_at(std::chrono::steady_clock::time_point(due->time_since_epoch()));
  timer_.async_wait([self = shared_from_this()](const boost::system::error_code& e) {
    if (e) return;
    self->armed_for_.reset();
    self->pump();
  });
}

void Connection::finish() {
  if (std::exchange(finished_, true)) return;
  if (runner_) host_.end_stream(std::move(runner_));
  timer_.cancel();
  boost::system::error_code ignored;
  socket_.shutdown(tcp::socket::shutdown_both, ignored);
  socket_.close(ignored);
  host_.on_closed(*this);
}

}  // namespace atlaswire::server
