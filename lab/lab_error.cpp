#include "lab/lab_error.h"

namespace atlaswire::lab {

const char* error_text(LabError e) {
  switch (e) {
    case LabError::kSyntax:
      return "not TOML";
    case LabError::kUnknownKey:
      return "unknown key";
    case LabError::kOutOfRange:
      return "value not allowed";
    case LabError::kNotFound:
      return "not found";
    case LabError::kBadRecord:
      return "not a record of atlas-lab";
    case LabError::kOtherCommit:
      return "results of different programs must not mix";
  }
  return "unknown error";
}

}  // namespace atlaswire::lab
