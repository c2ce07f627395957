#include "render/image/png.h"
#include "server/daemon_impl.h"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <csignal>

namespace atlaswire::server {

void Daemon::Impl::watch_requests() {
  boost::system::error_code ignored;
  if (hooks_.reread) requests_.add(SIGHUP, ignored);
  if (!settings_.layout_picture.empty()) requests_.add(SIGUSR1, ignored);
  wait_request();
}

void Daemon::Impl::wait_request() {
  requests_.async_wait([this](const boost::system::error_code& e, int number) {
    if (e) return;
    if (number == SIGHUP) reload_now();
    if (number == SIGUSR1) draw_layout_now();
    wait_request();
  });
}

void Daemon::Impl::reload() {
  asio::post(io_, [this] { reload_now(); });
}

void Daemon::Impl::reload_now() {
  if (!hooks_.reread) return;
  try {
    settings_.stream.render.emphasis = hooks_.reread();
  } catch (const ProgramError& e) {
    spdlog::warn("nothing was reloaded: {}", e.what());
    return;
  }
  spdlog::info("reloaded: foveation {}, {} priorities", emphasis().foveation.value_or(0),
               emphasis().priorities.size());
  for (const auto& connection : snapshot()) connection->on_emphasis();
}

void Daemon::Impl::draw_layout() {
  asio::post(io_, [this] { draw_layout_now(); });
}

void Daemon::Impl::draw_layout_now() {
  const auto connection = mirrored_ ? connections_.find(*mirrored_) : connections_.end();
  if (connection == connections_.end() || !connection->second->request_layout()) {
    spdlog::warn("no session streams: no layout to draw");
  }
}

/// Encoding thread.
void Daemon::Impl::keep_layout(SessionId session, const render::Picture& layout) const {
  if (const auto written = render::write_png(layout, settings_.layout_picture); !written) {
    spdlog::warn("--layout-picture: {}", written.error().message());
    return;
  }
  spdlog::info("session {}: layout drawn into {}", value(session), settings_.layout_picture);
}

}  // namespace atlaswire::server
