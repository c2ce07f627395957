#pragma once

#include <boost/system/result.hpp>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace atlaswire {

/// Why peer bytes, a file or an ordinary operation failed: a registered code, and (where there is room
/// for one) a sentence that names the offending thing. Hot parsers leave `detail` empty: no allocation.
struct Error {
  std::error_code code;
  std::string detail;

  Error() = default;  ///< no error: what `Result::error()` gives for a value
  Error(std::error_code c, std::string d = {}) : code(c), detail(std::move(d)) {}
  template <class Enum>
  requires std::is_error_code_enum_v<Enum> Error(Enum e, std::string d = {})
      : code(e), detail(std::move(d)) {}

  /// One line for people: "detail: code message", or the code's message alone.
  [[nodiscard]] std::string message() const;
};

/// Thrown by `Result::value()` on an error; caught in `main` and at session edges.
class ResultError : public std::runtime_error {
 public:
  explicit ResultError(const Error& error);
};

/// Found by argument-dependent lookup from boost::system::result<T, Error>::value().
[[noreturn]] void throw_exception_from_error(const Error& error, const boost::source_location& where);

/// What functions return that read peer bytes or files: the value or an Error. Never thrown across rooms.
template <class T>
using Result = boost::system::result<T, Error>;

}  // namespace atlaswire
