#pragma once

#include "base/result.h"

#include <filesystem>

namespace atlaswire::lab {

/// Makes plots and report.html in a results folder from its results.json, with the Python scripts in
/// share/atlas-lab beside the program's bin folder. Errors (kNotFound): no scripts, no Python with
/// matplotlib, or what the scripts said.
Result<void> make_report(const std::filesystem::path& folder);

}  // namespace atlaswire::lab
