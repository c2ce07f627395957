#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace atlaswire::proto {

/// Is `text` one line for people: well-formed UTF-8 without control characters? What a peer sends goes to
/// logs and terminals, so nothing else is let in.
[[nodiscard]] bool is_plain_text(std::string_view text);

/// `text` made plain: control characters become blanks, ill-formed octets '?'; cut to `limit` octets at a
/// character's end.
std::string to_plain_text(std::string_view text, std::size_t limit);

}  // namespace atlaswire::proto
