#pragma once

#include <string>
#include <system_error>

namespace atlaswire {

/// An error category over one enum: `text(Enum)` gives the message. Use with ATLASWIRE_ERROR_ENUM.
template <class Enum, const char* Name>
class EnumCategory final : public std::error_category {
 public:
  [[nodiscard]] const char* name() const noexcept override { return Name; }
  [[nodiscard]] std::string message(int value) const override { return error_text(static_cast<Enum>(value)); }
};

}  // namespace atlaswire

/// Registers `atlaswire::SPACE::ENUM` as an error code. Write it at file scope in the header, after an
/// `enum class ENUM` (values from 1) and `const char* error_text(ENUM)` in the same namespace.
#define ATLASWIRE_ERROR_ENUM(SPACE, ENUM)                                       \
  namespace atlaswire::SPACE {                                                  \
  inline constexpr char kCategoryName##ENUM[] = "atlaswire." #SPACE "." #ENUM;  \
  inline std::error_code make_error_code(ENUM e) {                              \
    static const ::atlaswire::EnumCategory<ENUM, kCategoryName##ENUM> category; \
    return {static_cast<int>(e), category};                                     \
  }                                                                             \
  }                                                                             \
  template <>                                                                   \
  struct std::is_error_code_enum<::atlaswire::SPACE::ENUM> : std::true_type {}
