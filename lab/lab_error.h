#pragma once

#include "base/error_enum.h"
#include "base/result.h"

namespace atlaswire::lab {

/// Why an experiment, a setting or a results folder cannot be used.
enum class LabError {
  kSyntax = 1,
  kUnknownKey,
  kOutOfRange,
  kNotFound,
  kBadRecord,    ///< a file of a results folder that atlas-lab did not write so
  kOtherCommit,  ///< a results folder with points of another commit or build
};
const char* error_text(LabError e);

}  // namespace atlaswire::lab
ATLASWIRE_ERROR_ENUM(lab, LabError);
