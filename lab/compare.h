#pragma once

#include "lab/point_result.h"

#include <filesystem>
#include <vector>

namespace atlaswire::lab {

/// Every metric of render/image of one PNG against a reference of the same size. Throws ProgramError(kUsage)
/// naming what does not fit.
std::vector<Figure> compare_pictures(const std::filesystem::path& reference,
                                     const std::filesystem::path& picture);

}  // namespace atlaswire::lab
