#pragma once

#include "base/program.h"

#include <cstdint>
#include <string>

namespace atlaswire::client {

/// Why a session is over.
struct SessionEnd {
  enum class Kind : std::uint8_t {
    kFinished,       ///< we said Goodbye
    kServerDone,     ///< the server said Goodbye for a reason that is no failure: done, draining
    kNoAnswer,       ///< the connection closed, or patience ran out, before the server answered
    kRefused,        ///< the server said no
    kServerGone,     ///< the connection closed, the server fell silent, or it gave up on us
    kProtocolError,  ///< the server broke the protocol
  };
  Kind kind = Kind::kFinished;
  std::string text;  ///< one line for people: the cause and what to do; empty for kFinished
};

/// What a program exits with after such an end.
ExitCode exit_code(SessionEnd::Kind kind);

}  // namespace atlaswire::client
