#include "base/program.h"

#include <cstdio>

namespace atlaswire {

int run_program(const char* program, int argc, char** argv, int (*body)(int, char**)) {
  try {
    return body(argc, argv);
  } catch (const ProgramError& e) {
    std::fprintf(stderr, "%s: error: %s\n", program, e.what());
    return static_cast<int>(e.code());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: error: %s\n", program, e.what());
    return static_cast<int>(ExitCode::kInternal);
  }
}

}  // namespace atlaswire
