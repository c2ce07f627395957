#include "server/client_camera.h"
#include "server/daemon_impl.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>

namespace atlaswire::server {

std::optional<proto::Refusal> Daemon::Impl::admit(const Connection& connection) {
  using Code = proto::Refusal::Code;
  if (draining_) return proto::Refusal{Code::kDraining, "the server is shutting down"};
  const auto sessions = std::count_if(connections_.begin(), connections_.end(), [&](const auto& other) {
    const SessionState state = other.second->session().state();
    return other.second.get() != &connection &&
           (state == SessionState::kWaitingAddress || state == SessionState::kStreaming);
  });
  const std::uint32_t most = settings_.admission.max_sessions;
  // Streams that are ending still hold a device's memory: a storm of reconnects must not pile them up.
  if (static_cast<std::uint64_t>(sessions) >= most || reaper_->pending() >= most + 1) {
    return proto::Refusal{Code::kCapacity,
                          fmt::format("{} of {} sessions are taken; try again later", sessions, most)};
  }
  return std::nullopt;
}

const proto::StreamDescription& Daemon::Impl::description() const { return source_->description(); }

std::unique_ptr<StreamRunner> Daemon::Impl::start_stream(Connection& connection) {
  const proto::ClientHello& hello = connection.session().hello();
  StreamRunner::Settings runner;
  runner.max_fps = settings_.stream.max_fps;
  if (hello.wanted_frame_rate) runner.max_fps = std::min(runner.max_fps, *hello.wanted_frame_rate);
  runner.encoder_fps = settings_.stream.max_fps;
  runner.cover = settings_.stream.cover;
  runner.camera = client_camera(hello.display, hello.vertical_fov, source_->description().near_plane);
  runner.eye_separation = hello.eye_separation;
  runner.shows_motion = hello.shows_motion && source_->description().motion.has_value();
  runner.foresee_motion = settings_.stream.foresee_motion;
  runner.meta_codec = connection.session().meta_codec();
  runner.emphasis = emphasis();
  // Always told, since a warm stream may come from a client with another wish. Constant quality has no rate.
  if (const BitRate rate = settings_.stream.video.bit_rate; rate.bits_per_second != 0) {
    runner.bit_rate = std::min(rate, hello.wanted_bit_rate.value_or(rate));
  }
  const std::weak_ptr<Connection> weak = connection.weak_from_this();
  StreamRunner::Callbacks callbacks;
  callbacks.make = [this] { return source_->make(); };
  callbacks.give_back = [this](std::unique_ptr<FrameMaker> maker) { source_->give_back(std::move(maker)); };
  callbacks.on_frame = [this, weak](FramePtr frame) {
    asio::post(io_, [weak, frame = std::move(frame)] {
      if (const auto target = weak.lock()) target->on_frame(frame);
    });
  };
  callbacks.on_failure = [this, weak](std::string reason) {
    asio::post(io_, [weak, reason = std::move(reason)] {
      if (const auto target = weak.lock()) target->on_stream_failure(reason);
    });
  };
  callbacks.on_layout = [this, id = connection.session().id()](const render::Picture& layout) {
    keep_layout(id, layout);
  };
  auto stream = std::make_unique<StreamRunner>(runner, std::move(callbacks));
  ++streaming_;
  if (!mirrored_) mirrored_ = connection.session().id();
  spdlog::info("session {}: {} ('{}', {}x{}) streams", value(connection.session().id()), connection.peer(),
               hello.client_name, hello.display.width, hello.display.height);
  return stream;
}

void Daemon::Impl::end_stream(std::unique_ptr<StreamRunner> runner) {
  --streaming_;
  reaper_->take(std::move(runner));
}

void Daemon::Impl::send(const Connection& connection, const OutgoingDatagram& datagram) {
  udp_->send(datagram.to, datagram.bytes);
  if (mirror_ && datagram.media && mirrored_ == connection.session().id()) mirror_->send(datagram.bytes);
}

void Daemon::Impl::on_address(Connection& connection, const proto::PeerAddress& address) {
  const SessionId id = connection.session().id();
  std::erase_if(by_address_, [&](const auto& entry) { return entry.second == id; });
  by_address_[address] = id;
  spdlog::debug("session {}: media goes to {}", value(id), to_text(address));
}

void Daemon::Impl::on_departure(const Connection& connection, const Departure& departure) {
  csv_.add(connection.session().id(), departure);
  line_.add(departure);
}

void Daemon::Impl::on_closed(Connection& connection) {
  const Session& session = connection.session();
  const SessionCounts& counts = session.counts();
  spdlog::info("session {}: {} ended: {} ({} frames, {} dropped, {} picture losses, {} datagrams ignored)",
               value(session.id()), connection.peer(), session.end_reason(), counts.frames,
               counts.frames_dropped, counts.picture_losses, counts.ignored_datagrams);
  const SessionId id = session.id();
  std::erase_if(by_address_, [&](const auto& entry) { return entry.second == id; });
  connections_.erase(id);
  if (mirrored_ == id) {
    mirrored_.reset();
    for (const auto& other : connections_) {
      if (other.second->session().state() == SessionState::kStreaming && !mirrored_) mirrored_ = other.first;
    }
  }
  finish_drain();
}

}  // namespace atlaswire::server
