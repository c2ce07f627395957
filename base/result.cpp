#include "base/result.h"

namespace atlaswire {

std::string Error::message() const {
  return detail.empty() ? code.message() : detail + ": " + code.message();
}

ResultError::ResultError(const Error& error) : std::runtime_error(error.message()) {}

void throw_exception_from_error(const Error& error, const boost::source_location&) {
  throw ResultError(error);
}

}  // namespace atlaswire
