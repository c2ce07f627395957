#pragma once

#include "lab/contender.h"

namespace atlaswire::lab {

/// Shading atlas streaming: the daemon's stream and the client's pairing and display, as they are.
std::unique_ptr<Contender> make_sas_contender(const PointSettings& settings, render::Device& device,
                                              std::shared_ptr<const render::Scene> scene);

}  // namespace atlaswire::lab
