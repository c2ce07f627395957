#pragma once

#include "lab/carrier.h"
#include "lab/network_ends.h"

namespace atlaswire::lab {

/// Real sessions over a modelled network: handshake, poses, pacing, packets, losses and recovery are those of
/// the daemon and the client, in virtual time.
class SessionCarrier final : public Carrier {
 public:
  /// All are borrowed. Throws ProgramError for a profile that cannot be used, and for pictures that are not
  /// coded: packets carry H.264.
  SessionCarrier(const PointSettings& settings, FrameSource& source, Contender& contender,
                 const HeadMotion& motion);

  void advance(Duration now) override;
  [[nodiscard]] Duration first_frame() const override;
  [[nodiscard]] Duration posed(FrameId frame) const override;
  void add_figures(std::vector<Figure>& figures) const override;

 private:
  ServerEnd server_;
  ClientEnd client_;
  netsim::VirtualDriver driver_;
};

}  // namespace atlaswire::lab
