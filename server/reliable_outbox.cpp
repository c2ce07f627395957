#include "server/reliable_outbox.h"

#include "base/assert.h"

#include <utility>

namespace atlaswire::server {

void ReliableOutbox::push(const proto::Message& message, Time now) {
  proto::append_message(message, waiting_);
  if (leaving_.empty()) std::swap(leaving_, waiting_);
  note_level(now);
}

void ReliableOutbox::consume(std::size_t count, Time now) {
  AW_ASSERT(count <= leaving_.size() - left_);
  left_ += count;
  if (left_ == leaving_.size()) {
    leaving_.clear();
    left_ = 0;
    std::swap(leaving_, waiting_);
  }
  note_level(now);
}

void ReliableOutbox::note_level(Time now) {
  if (!is_over()) {
    over_since_.reset();
  } else if (!over_since_) {
    over_since_ = now;
  }
}

bool ReliableOutbox::is_stalled(Time now) const {
  return size() > 4 * settings_.bound || (over_since_ && now - *over_since_ >= settings_.stall_timeout);
}

std::optional<Time> ReliableOutbox::next_deadline() const {
  if (!over_since_) return std::nullopt;
  return *over_since_ + settings_.stall_timeout;
}

}  // namespace atlaswire::server
