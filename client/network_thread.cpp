#include "client/network_thread.h"

#include "client/pose_history.h"
#include "client/session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace atlaswire::client {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using boost::system::error_code;

constexpr Duration kRetryInterval = std::chrono::milliseconds(200);
constexpr Duration kAttemptTimeout = std::chrono::seconds(1);
constexpr Duration kSnapshotInterval = std::chrono::milliseconds(20);
constexpr Duration kInterruptCheck = std::chrono::milliseconds(20);
constexpr Duration kFlushTimeout = std::chrono::seconds(1);
constexpr Duration kBackPressurePause = std::chrono::milliseconds(2);
constexpr int kDatagramsPerTurn = 64;

asio::steady_timer::time_point timer_point(Time t) {
  return asio::steady_timer::time_point{
      std::chrono::duration_cast<asio::steady_timer::duration>(t.time_since_epoch())};
}

asio::const_buffer to_buffer(ByteView bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace

class NetworkThread::Impl {
 public:
  Impl(NetworkSettings settings, ArrivalQueue& arrivals)
      : settings_(std::move(settings)), arrivals_(&arrivals), deadline_(steady_now() + settings_.wait) {
    resolve();
    thread_ = std::thread([this] { run(); });
  }

  ~Impl() {
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  std::optional<proto::ServerHello> wait_for_answer(const std::function<bool()>& interrupted) {
    std::unique_lock lock(mutex_);
    while (!answer_ && !end_ && !interrupted()) changed_.wait_for(lock, kInterruptCheck);
    return answer_;
  }

  void finish() {
    asio::post(io_, [this] {
      if (session_) {
        session_->finish();
        flush();
      } else {
        end_with({.kind = SessionEnd::Kind::kFinished, .text = {}});
      }
    });
    if (thread_.joinable()) thread_.join();
  }

  void with_session(std::function<void(Session&)> action) {
    asio::post(io_, [this, action = std::move(action)] {
      if (!session_) return;
      action(*session_);
      flush();
    });
  }

  [[nodiscard]] NetworkSnapshot snapshot() const {
    const std::lock_guard lock(mutex_);
    return snapshot_;
  }

  [[nodiscard]] std::optional<SessionEnd> end() const {
    const std::lock_guard lock(mutex_);
    return end_;
  }

 private:
  void run() {
    try {
      io_.run();
    } catch (const std::exception& e) {
      end_with(
          {.kind = SessionEnd::Kind::kServerGone, .text = fmt::format("the network failed: {}", e.what())});
    }
    end_with({.kind = SessionEnd::Kind::kFinished, .text = {}});
    arrivals_->close();
  }

  // Connecting: resolve, then try the addresses until one accepts or patience is over.

  void resolve() {
    resolver_.async_resolve(settings_.server.host, std::to_string(settings_.server.port),
                            [this](const error_code& error, const tcp::resolver::results_type& found) {
                              if (error) return connect_failed(error, false);
                              addresses_ = found;
                              connect();
                            });
  }

  void connect() {
    const Time patience = std::max(deadline_, steady_now() + kAttemptTimeout);
    attempt_over_ = false;
    timer_.expires_at(timer_point(patience));
    timer_.async_wait([this](const error_code& error) {
      if (!error && !attempt_over_) tcp_.close();
    });
    asio::async_connect(tcp_, addresses_, [this](const error_code& error, const tcp::endpoint& address) {
      attempt_over_ = true;
      timer_.cancel();
      if (error) return connect_failed(error, true);
      start_session(address);
    });
  }

  void connect_failed(const error_code& error, bool may_retry) {
    if (may_retry && steady_now() + kRetryInterval < deadline_) {
      error_code ignored;
      tcp_.close(ignored);
      timer_.expires_after(kRetryInterval);
      timer_.async_wait([this](const error_code& stopped) {
        if (!stopped) connect();
      });
      return;
    }
    const std::string why = error == asio::error::operation_aborted ? "no answer" : error.message();
    end_with({.kind = SessionEnd::Kind::kNoAnswer,
              .text = fmt::format("cannot connect to {}: {}; start atlasd there, check the address, or wait "
                                  "longer with --wait",
                                  to_string(settings_.server), why)});
  }

  void start_session(const tcp::endpoint& address) {
    error_code ignored;
    tcp_.set_option(tcp::no_delay(true), ignored);
    const udp::endpoint server(address.address(), address.port());
    udp_.open(server.protocol());
    udp_.set_option(asio::socket_base::receive_buffer_size(4 << 20), ignored);
    udp_.connect(server);
    udp_.non_blocking(true);
    session_.emplace(settings_.session, steady_now());
    next_pose_ = steady_now();
    read_stream();
    read_datagrams();
    flush();
  }

  // Carrying.

  void read_stream() {
    if (arrivals_->size() > kMaxQueuedUpdates) {
      pause_.expires_after(kBackPressurePause);
      pause_.async_wait([this](const error_code& stopped) {
        if (!stopped && !session_->end()) read_stream();
      });
      return;
    }
    tcp_.async_read_some(asio::buffer(stream_in_), [this](const error_code& error, std::size_t count) {
      if (session_->end()) return;
      if (error) {
        session_->on_stream_closed(steady_now());
      } else {
        session_->on_stream_bytes(ByteView(stream_in_).first(count), steady_now());
      }
      flush();
      if (!session_->end()) read_stream();
    });
  }

  void read_datagrams() {
    udp_.async_wait(udp::socket::wait_read, [this](const error_code& stopped) {
      if (stopped || session_->end()) return;
      for (int i = 0; i < kDatagramsPerTurn; ++i) {
        error_code error;
        const std::size_t count = udp_.receive(asio::buffer(datagram_in_), 0, error);
        if (error == asio::error::would_block) break;
        if (!error) session_->on_datagram(ByteView(datagram_in_).first(count), steady_now());
      }
      flush();
      if (!session_->end()) read_datagrams();
    });
  }

  /// After every call of the session: sends what it wants sent, hands over what it has, sets the alarm.
  void flush() {
    const Time now = steady_now();
    // `poll` may be due at once after any input; its own next deadline then lies ahead.
    if (const auto due = session_->next_deadline(); due && *due <= now) session_->poll(now);
    sample_pose(now);
    hand_over();
    publish(now);
    write_stream();
    while (auto datagram = session_->pop_datagram()) {
      error_code ignored;  // a datagram that cannot leave is a lost one
      udp_.send(to_buffer(*datagram), 0, ignored);
    }
    if (session_->end()) return close_when_written();
    set_alarm();
  }

  void sample_pose(Time now) {
    if (now < next_pose_ || !session_->answer() || session_->end()) return;
    next_pose_ = std::max(next_pose_ + settings_.pose_interval, now);
    const std::optional<Pose> pose = settings_.sample_pose(now);
    if (!pose) return;
    if (const auto id = session_->on_pose(*pose, now)) poses_.add({.id = *id, .sampled = now, .pose = *pose});
  }

  void set_alarm() {
    Time next = session_->answer() ? next_pose_ : Time::max();
    if (const auto due = session_->next_deadline()) next = std::min(next, *due);
    timer_.expires_at(timer_point(next));
    timer_.async_wait([this](const error_code& stopped) {
      if (!stopped && !session_->end()) flush();
    });
  }

  void hand_over() {
    while (auto update = session_->pop_update()) {
      const ServerTimes server = server_times(update->meta);
      ++updates_;
      auto arrival = std::make_unique<UpdateArrival>(UpdateArrival{std::move(*update), server});
      if (!arrivals_->try_push({.frame = nullptr, .update = std::move(arrival)})) {
        session_->fail("the viewer cannot keep up with the server's meta updates");
      }
    }
    while (auto frame = session_->pop_frame()) {
      auto arrival = std::make_unique<proto::AssembledFrame>(std::move(*frame));
      if (arrivals_->size() < kMaxQueuedFrames &&
          arrivals_->try_push({.frame = std::move(arrival), .update = nullptr}))
        continue;
      ++overrun_frames_;
      session_->on_decode_failed();
    }
  }

  [[nodiscard]] ServerTimes server_times(const proto::FrameMeta& meta) const {
    const proto::ClockSync& clock = *session_->clock();
    const auto here = [&](Time server) { return clock.to_client(to_nanos(server)); };
    const bool known = clock.is_synchronized();
    return {.pose = known ? poses_.find(meta.pose) : std::nullopt,
            .pose_received = here(meta.stamps.pose_received),
            .render_start = here(meta.stamps.render_start),
            .encode_end = here(meta.stamps.encode_end)};
  }

  void write_stream() {
    const ByteBuffer more = session_->take_stream_bytes();
    stream_out_.insert(stream_out_.end(), more.begin(), more.end());
    if (writing_ || stream_out_.empty()) return;
    writing_ = true;
    stream_writing_ = std::exchange(stream_out_, {});
    asio::async_write(tcp_, to_buffer(stream_writing_), [this](const error_code& error, std::size_t) {
      writing_ = false;
      if (error) stream_out_.clear();
      if (session_->end()) return close_when_written();
      if (!error) write_stream();
    });
  }

  void close_when_written() {
    end_with(*session_->end());
    if (writing_ || !stream_out_.empty()) {
      if (!writing_) write_stream();
      timer_.expires_after(kFlushTimeout);
      timer_.async_wait([this](const error_code& stopped) {
        if (!stopped) io_.stop();
      });
      return;
    }
    error_code ignored;
    tcp_.shutdown(tcp::socket::shutdown_both, ignored);
    io_.stop();
  }

  // What other threads see.

  void publish(Time now) {
    const bool news = session_->answer().has_value() && !answered_;
    const bool over = session_->end().has_value();
    if (!news && !over && now < snapshot_.taken + kSnapshotInterval) return;
    const std::lock_guard lock(mutex_);
    snapshot_.taken = now;
    snapshot_.traffic = session_->traffic();
    snapshot_.packets = session_->packets();
    snapshot_.frames = session_->frames();
    snapshot_.updates = updates_;
    snapshot_.overrun_frames = overrun_frames_;
    if (const proto::ClockSync* clock = session_->clock(); clock != nullptr && clock->is_synchronized()) {
      snapshot_.clock_synchronized = true;
      snapshot_.clock_offset = clock->offset();
      snapshot_.clock_error = clock->error_bound(now);
      snapshot_.round_trip = clock->round_trip();
    }
    if (news) {
      answered_ = true;
      answer_ = session_->answer();
      changed_.notify_all();
    }
  }

  void end_with(SessionEnd why) {
    {
      const std::lock_guard lock(mutex_);
      if (end_) return;
      end_ = std::move(why);
    }
    changed_.notify_all();
    arrivals_->close();
    if (!session_) io_.stop();
  }

  NetworkSettings settings_;
  ArrivalQueue* arrivals_;
  Time deadline_;
  asio::io_context io_{1};
  tcp::resolver resolver_{io_};
  tcp::resolver::results_type addresses_;
  tcp::socket tcp_{io_};
  udp::socket udp_{io_};
  asio::steady_timer timer_{io_};  ///< connecting, then the session's alarm, then the last flush
  asio::steady_timer pause_{io_};
  bool attempt_over_ = false;
  std::optional<Session> session_;
  PoseHistory poses_;
  Time next_pose_{};
  std::uint64_t updates_ = 0;
  std::uint64_t overrun_frames_ = 0;
  bool answered_ = false;
  bool writing_ = false;
  ByteBuffer stream_out_;
  ByteBuffer stream_writing_;
  std::array<std::byte, 65536> stream_in_{};
  std::array<std::byte, 65536> datagram_in_{};

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<proto::ServerHello> answer_;
  std::optional<SessionEnd> end_;
  NetworkSnapshot snapshot_;
  std::thread thread_;
};

NetworkThread::NetworkThread(NetworkSettings settings, ArrivalQueue& arrivals)
    : impl_(std::make_unique<Impl>(std::move(settings), arrivals)) {}
NetworkThread::~NetworkThread() = default;

std::optional<proto::ServerHello> NetworkThread::wait_for_answer(const std::function<bool()>& interrupted) {
  return impl_->wait_for_answer(interrupted);
}
void NetworkThread::finish() { impl_->finish(); }

void NetworkThread::set_progress(const Progress& progress) {
  impl_->with_session([progress](Session& s) { s.set_progress(progress); });
}
void NetworkThread::decode_failed() {
  impl_->with_session([](Session& s) { s.on_decode_failed(); });
}
void NetworkThread::request_restart(FrameId frame, std::string why) {
  impl_->with_session([frame, why = std::move(why)](Session& s) { s.request_restart(frame, why); });
}
void NetworkThread::fail(std::string why) {
  impl_->with_session([why = std::move(why)](Session& s) { s.fail(why); });
}
NetworkSnapshot NetworkThread::snapshot() const { return impl_->snapshot(); }
std::optional<SessionEnd> NetworkThread::end() const { return impl_->end(); }

}  // namespace atlaswire::client
