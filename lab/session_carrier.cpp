#include "lab/session_carrier.h"

#include "base/program.h"
#include "lab/coding.h"
#include "netsim/profile.h"

#include <algorithm>
#include <utility>

namespace atlaswire::lab {
namespace {

/// The path starts here; sessions before it, so that the handshake is through in time on the slowest
/// profile that ships.
constexpr Time kZero = Time{} + std::chrono::seconds(100);
constexpr Duration kLead = std::chrono::seconds(3);

netsim::Profile load(const PointSettings& settings) {
  if (video_coding(settings) == codec::VideoCoding::kRaw) {
    throw ProgramError(ExitCode::kUsage,
                       "a network 'profile' carries coded pictures: set bitrate_mbps or qp");
  }
  Result<netsim::Profile> profile = netsim::load_profile(settings.profile);
  if (!profile) throw ProgramError(ExitCode::kUsage, profile.error().message());
  return std::move(*profile);
}

}  // namespace

SessionCarrier::SessionCarrier(const PointSettings& settings, FrameSource& source, Contender& contender,
                               const HeadMotion& motion)
    : server_(settings, source, contender, kZero - kLead, kZero),
      client_(settings, contender, motion, kZero - kLead, kZero),
      driver_(client_, server_, load(settings), settings.seed, kZero - kLead) {}

void SessionCarrier::advance(Duration now) { driver_.run_until(kZero + now); }

Duration SessionCarrier::first_frame() const {
  const auto first = server_.first_frame();
  return first ? *first - kZero : Duration::zero();
}

Duration SessionCarrier::posed(FrameId frame) const { return client_.posed(frame) - kZero; }

void SessionCarrier::add_figures(std::vector<Figure>& figures) const {
  const auto packets = client_.session().packets();
  const auto frames = client_.session().frames();
  figures.push_back({"frames_lost", static_cast<double>(frames.lost + frames.withheld)});
  const double lost = std::max(0.0, static_cast<double>(packets.lost));
  const double expected = static_cast<double>(frames.packets) + lost;
  figures.push_back({"packets_lost_percent", expected > 0 ? 100 * lost / expected : 0.0});
  const auto start = server_.first_frame();
  const auto whole = client_.first_whole_frame();
  figures.push_back({"first_picture_ms", start && whole ? to_ms(*whole - *start) : kNotApplicable});
}

}  // namespace atlaswire::lab
