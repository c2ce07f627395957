#pragma once

namespace atlaswire {

/// What every program's --version says; CMakeLists.txt reads it from here.
inline constexpr const char* kVersion = "0.1.0";

}  // namespace atlaswire
