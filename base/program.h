#pragma once

#include "base/result.h"

#include <string>

namespace atlaswire {

/// Exit codes of every program; scripts may rely on them (docs/OPERATIONS.md lists them).
enum class ExitCode : int {
  kOk = 0,
  kInternal = 1,       ///< a bug or an unforeseen failure
  kUsage = 2,          ///< unknown option, bad value, bad config file
  kBadScene = 3,       ///< scene or camera path missing, malformed or unsupported
  kNoDevice = 4,       ///< no usable Vulkan device
  kPortInUse = 5,      ///< cannot listen
  kCannotConnect = 6,  ///< nobody listens there, or the connection broke before the handshake ended
  kRefused = 7,        ///< the peer refused: version, capacity, credentials
  kPeerLost = 8,       ///< the peer vanished or broke the protocol after the handshake
  kCannotWrite = 9,    ///< an output file or directory
  kInterrupted = 130,  ///< SIGINT before any work was done
};

/// A start-up failure that `main` turns into one clear line and an exit code. `what()` names the attempt
/// and the cure.
class ProgramError : public std::runtime_error {
 public:
  ProgramError(ExitCode code, const std::string& what) : std::runtime_error(what), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Runs a program's body, printing what it throws as "PROGRAM: error: ..." on stderr; gives main's value.
int run_program(const char* program, int argc, char** argv, int (*body)(int, char**));

}  // namespace atlaswire
