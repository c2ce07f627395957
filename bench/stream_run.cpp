#include "bench/stream_run.h"

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <numeric>
#include <optional>
#include <vector>

namespace atlaswire::bench {

namespace {

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Milliseconds of this thread that a call takes, whatever else the machine is busy with.
template <class Call>
double time_of(Call call) {
  const double start = thread_ms();
  call();
  return thread_ms() - start;
}

/// One number an update.
using Series = std::vector<double>;

Series series_of(const std::vector<UpdateCost>& costs, std::size_t UpdateCost::*part) {
  Series series(costs.size());
  std::ranges::transform(costs, series.begin(),
                         [&](const UpdateCost& c) { return static_cast<double>(c.*part); });
  return series;
}
Series later(const Series& all) { return {all.begin() + 1, all.end()}; }
double mean(const Series& all) {
  return all.empty() ? 0 : std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}
double p95(Series all) {
  if (all.empty()) return 0;
  std::ranges::sort(all);
  return all[(all.size() - 1) * 95 / 100];
}
Series sum(Series a, const Series& b) {
  std::ranges::transform(a, b, a.begin(), std::plus<>());
  return a;
}

/// What something takes, update by update.
struct Costs {
  Series octets;
  Series encode;
  Series decode;
};

/// Every way in which a codec may tell motion, side by side.
class MotionRun {
 public:
  MotionRun(MotionRivals rivals, const RecordedMotion& motion)
      : follower_(motion), rivals_(std::move(rivals)), costs_(rivals_.size()) {}

  void next(const codec::MetaUpdate& told, const codec::MetaUpdate& heard) {
    const MotionStep& step = follower_.next(told);
    for (std::size_t i = 0; i < rivals_.size(); ++i) {
      MotionRival& rival = *rivals_[i];
      costs_[i].encode.push_back(time_of([&] { rival.encode(step); }));
      costs_[i].decode.push_back(time_of([&] { rival.decode(heard); }));
      costs_[i].octets.push_back(static_cast<double>(rival.size()));
      rival.check(step);
    }
  }
  /// Of the one that took the fewest octets.
  [[nodiscard]] const Costs& best() const {
    return *std::ranges::min_element(costs_, {}, [](const Costs& c) { return mean(c.octets); });
  }

 private:
  MotionFollower follower_;
  MotionRivals rivals_;
  std::vector<Costs> costs_;
};

}  // namespace

Row run_stream(CodecRival& rival, const std::string& stream, const MetaRecording& recording) {
  Row row{.stream = stream, .codec = rival.name()};
  std::optional<MotionRun> motion;
  if (recording.motion) motion.emplace(rival.motions(*recording.motion), *recording.motion);
  IncrementMaker maker;
  std::vector<Increment> increments;
  double triangles = 0;
  for (const codec::MetaUpdate& update : recording.updates) {
    increments.push_back(maker.next(update));
    triangles += IncrementMaker::added_triangles(update);
  }
  Costs costs;
  std::vector<UpdateCost> sizes;
  for (const Increment& increment : increments) {
    costs.encode.push_back(time_of([&] { rival.encode(increment); }));
    costs.decode.push_back(time_of([&] { rival.decode(); }));
    rival.check();
    if (motion) motion->next(*increment.update, rival.heard());
    costs.decode.back() += time_of([&] { rival.place(); });
    sizes.push_back(rival.cost());
  }
  if (sizes.empty()) return row;
  rival.split(recording.updates, sizes);
  row.first = sizes.front();
  const Series mesh = series_of(sizes, &UpdateCost::mesh);
  const Series blocks = series_of(sizes, &UpdateCost::blocks);
  row.bits_a_triangle = 8 * std::accumulate(mesh.begin(), mesh.end(), 0.0) / std::max(1.0, triangles);
  row.mesh = mean(later(mesh));
  row.blocks = mean(later(blocks));
  if (motion) {
    const Costs& best = motion->best();
    row.first_motion = best.octets.front();
    row.motion = mean(later(best.octets));
    row.motion_encode = mean(later(best.encode));
    row.motion_decode = mean(later(best.decode));
    costs.encode = sum(std::move(costs.encode), best.encode);
    costs.decode = sum(std::move(costs.decode), best.decode);
  }
  row.first_encode = costs.encode.front();
  row.first_decode = costs.decode.front();
  row.encode = mean(later(costs.encode));
  row.encode_p95 = p95(later(costs.encode));
  row.decode = mean(later(costs.decode));
  row.decode_p95 = p95(later(costs.decode));
  return row;
}

}  // namespace atlaswire::bench
