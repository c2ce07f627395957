#pragma once

#include "base/ids.h"
#include "base/time.h"
#include "server/media_outbox.h"

#include <cstdint>
#include <fstream>
#include <string>

namespace atlaswire::server {

/// A line per frame, for people who measure: stage times in ms, bytes, patches, atlas usage.
class StatsCsv {
 public:
  /// Empty path: writes nothing. Throws ProgramError (kCannotWrite).
  explicit StatsCsv(const std::string& path);
  void add(SessionId session, const Departure& departure);

 private:
  std::ofstream file_;
};

/// Sums over the frames of all sessions since the last line.
class StatsLine {
 public:
  void add(const Departure& departure);
  /// One line over `elapsed`, "fps 14.9 | video 9.81 Mbps ..."; begins anew.
  std::string take(Duration elapsed, std::size_t sessions);
  /// The atlases' memory over the same frames, "allocated 35.1 %, tails 3.2 % ..."; call it before `take`.
  [[nodiscard]] std::string atlas() const;

 private:
  struct Sums {
    std::uint64_t frames = 0;
    std::uint64_t dropped = 0;
    std::uint64_t video_bytes = 0;
    std::uint64_t meta_bytes = 0;
    std::uint64_t visible = 0;
    render::AtlasUsage usage;  ///< texels, summed
    std::uint64_t moved = 0;
    std::uint64_t refused = 0;
    std::uint64_t resets = 0;
    double bias = 0;
    Duration visibility{};
    Duration allocation{};
    Duration shading{};
    Duration conversion{};
    Duration render{};
    Duration encode{};
    Duration send{};
  };
  Sums sums_;
};

}  // namespace atlaswire::server
