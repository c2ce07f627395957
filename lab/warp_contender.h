#pragma once

#include "lab/contender.h"
#include "render/warp/view_warp.h"

namespace atlaswire::lab {

/// Ordinary pictures, redrawn by a warp: what [SAS] 5.6 to 5.8 compare with.
std::unique_ptr<Contender> make_warp_contender(render::WarpKind kind, const PointSettings& settings,
                                               render::Device& device,
                                               std::shared_ptr<const render::Scene> scene);

}  // namespace atlaswire::lab
