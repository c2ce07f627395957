#pragma once

#include "lab/point_result.h"
#include "lab/truth.h"
#include "render/image/picture.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace atlaswire::lab {

/// A displayed frame and what should have been seen.
struct Displayed {
  TruePicture truth;
  render::Picture view;
};

/// Compares displayed frames with the truth ([SAS] 5.6) and keeps the pictures worth looking at.
class Meter {
 public:
  /// `flip`: measured too. `pictures`: existing folder for them; empty: none.
  Meter(bool flip, std::filesystem::path pictures);

  /// A frame and the one displayed before it, which flicker needs.
  void add(double t_s, double pose_age_ms, const Displayed& before, const Displayed& now);
  /// Means over frames, the lowest MSSIM, and what forward and deferred shading of every displayed frame
  /// would cost at `client_hz` ([SAS] fig. 12).
  void add_figures(double client_hz, std::vector<Figure>& figures) const;
  [[nodiscard]] const std::vector<FrameRow>& rows() const { return rows_; }
  /// Writes `worst.png` (lowest MSSIM) and `last.png`: truth, view and their difference. Throws ProgramError.
  void write_pictures() const;

 private:
  struct Kept {
    FrameRow row;
    Displayed shown;
  };
  void write(const char* name, const Kept& kept) const;

  bool flip_;
  std::filesystem::path pictures_;
  std::vector<FrameRow> rows_;
  std::uint64_t forward_fragments_ = 0;
  std::uint64_t deferred_fragments_ = 0;
  Kept worst_;
  Kept last_;
};

}  // namespace atlaswire::lab
