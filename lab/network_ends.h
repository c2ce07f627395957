#pragma once

#include "base/pose.h"
#include "client/pose_history.h"
#include "client/session.h"
#include "lab/contender.h"
#include "lab/frame_source.h"
#include "lab/head_motion.h"
#include "lab/point.h"
#include "netsim/virtual_driver.h"
#include "server/cover_estimator.h"
#include "server/session.h"

#include <deque>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

namespace atlaswire::lab {

/// The flows between the two ends.
inline constexpr netsim::FlowId kDatagrams{1};
inline constexpr netsim::FlowId kReliable{2};

/// The daemon's session with its stream, without sockets: poses in, paced packets out. A frame takes
/// `server_ms` to make, the next one may start meanwhile.
class ServerEnd final : public netsim::Endpoint {
 public:
  /// Pointers are borrowed. `zero`: the instant of the path's start.
  ServerEnd(const PointSettings& settings, FrameSource& source, const Contender& contender, Time now,
            Time zero);

  void receive(netsim::FlowId flow, ByteView octets, Time now) override;
  [[nodiscard]] std::optional<Time> next_deadline() const override;
  void wake(Time now) override;
  std::vector<netsim::Outgoing> take_outgoing() override;

  /// When the first frame was started; nullopt: none yet.
  [[nodiscard]] std::optional<Time> first_frame() const { return first_frame_; }
  [[nodiscard]] const server::Session& session() const { return session_; }

 private:
  struct Ready {
    Time at{};
    server::FramePtr frame;
  };
  void react(Time now);
  void make_frame(const proto::ReceivedPose& pose, Time now);

  PointSettings settings_;
  FrameSource* source_;
  const Contender* contender_;
  Time now_;
  Time zero_;
  server::Session session_;
  server::CoverEstimator cover_;
  Duration interval_;
  Duration making_;
  std::optional<Time> next_frame_;  ///< nullopt: not streaming yet
  std::optional<Time> first_frame_;
  std::optional<Time> last_frame_;
  std::deque<Ready> ready_;
};

/// The client's session, which feeds the contender's client end `client_ms` after arrival.
class ClientEnd final : public netsim::Endpoint {
 public:
  /// Pointers are borrowed. Poses are sampled once a displayed frame.
  ClientEnd(const PointSettings& settings, Contender& contender, const HeadMotion& motion, Time now,
            Time zero);

  void receive(netsim::FlowId flow, ByteView octets, Time now) override;
  [[nodiscard]] std::optional<Time> next_deadline() const override;
  void wake(Time now) override;
  std::vector<netsim::Outgoing> take_outgoing() override;

  /// When the first frame had come whole, picture and update, and was decoded; nullopt: none yet.
  [[nodiscard]] std::optional<Time> first_whole_frame() const { return first_whole_; }
  /// When the pose was sampled that a delivered frame was made for.
  [[nodiscard]] Time posed(FrameId frame) const { return posed_.at(frame); }
  [[nodiscard]] const client::Session& session() const { return session_; }

 private:
  struct Waiting {
    Time due{};
    std::optional<proto::AssembledFrame> frame;
    std::optional<client::UpdateArrival> update;
  };
  void react(Time now);
  void sample_pose(Time now);
  void collect(Time now);
  void decode(Time now);
  void note_half(FrameId frame, Time now);

  Contender* contender_;
  const HeadMotion* motion_;
  Time zero_;
  client::Session session_;
  client::PoseHistory poses_;
  Duration pose_interval_;
  Duration decoding_;
  Time next_pose_;
  std::deque<Waiting> waiting_;
  std::unordered_map<FrameId, Time> posed_;
  std::set<FrameId> halves_;  ///< frames of which the update or the picture has come, until one is whole
  std::optional<Time> first_whole_;
};

}  // namespace atlaswire::lab
