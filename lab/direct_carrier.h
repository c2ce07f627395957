#pragma once

#include "lab/carrier.h"
#include "lab/contender.h"
#include "lab/frame_source.h"
#include "lab/head_motion.h"
#include "lab/point.h"

#include <cstdint>
#include <unordered_map>

namespace atlaswire::lab {

/// The static latency of [SAS] 5.6: every frame arrives whole, `latency_ms` after its pose was taken,
/// whatever its size. Frames arrive on the
/// server's beat from time zero on, so that at equal rates of server and client what is seen is exactly that
/// old.
class DirectCarrier final : public Carrier {
 public:
  /// All are borrowed.
  DirectCarrier(const PointSettings& settings, FrameSource& source, Contender& contender,
                const HeadMotion& motion);

  void advance(Duration now) override;
  [[nodiscard]] Duration first_frame() const override { return {}; }
  [[nodiscard]] Duration posed(FrameId frame) const override { return posed_.at(frame); }
  void add_figures(std::vector<Figure>& figures) const override;

 private:
  [[nodiscard]] Duration arrival_of(std::int64_t frame) const;
  void carry(std::int64_t frame);

  double rate_;  ///< Hz
  Duration latency_;
  FrameSource* source_;
  Contender* contender_;
  const HeadMotion* motion_;
  std::int64_t next_ = 0;  ///< arrives at 0
  std::unordered_map<FrameId, Duration> posed_;
};

}  // namespace atlaswire::lab
