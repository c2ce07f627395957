#pragma once

#include "base/ids.h"
#include "base/time.h"
#include "lab/point_result.h"

#include <vector>

namespace atlaswire::lab {

/// Brings a point's frames from the server's end to the client's in virtual time.
class Carrier {
 public:
  virtual ~Carrier() = default;
  /// Everything happens that is due up to and at `now`, which never decreases; times since the path's start.
  virtual void advance(Duration now) = 0;
  /// From when on frames travelled, for bytes a second; the client shows frames from 0 on.
  [[nodiscard]] virtual Duration first_frame() const = 0;
  /// When the pose was taken that `frame`, which was delivered, was made for.
  [[nodiscard]] virtual Duration posed(FrameId frame) const = 0;
  /// What the network did, as figures; the same names from every carrier.
  virtual void add_figures(std::vector<Figure>& figures) const = 0;
};

}  // namespace atlaswire::lab
