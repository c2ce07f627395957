#include "render/atlas/admission.h"

#include <array>

namespace atlaswire::render {

std::uint32_t Admission::admit(std::vector<BlockRequest>& requests) {
  if (most_new_ == 0) return 0;
  const auto area_of = [](const BlockRequest& r) { return (r.width_log2 + r.height_log2) & 31U; };
  std::array<std::uint32_t, 32> newcomers{};  // by area
  for (const BlockRequest& r : requests) {
    if (!admitted_[value(r.patch)]) ++newcomers[area_of(r)];
  }
  // Above the last area all get in, of it as many as there is room for, below it none.
  std::uint32_t last = 32;
  std::uint32_t room = most_new_;
  while (last > 0 && newcomers[last - 1] <= room) room -= newcomers[--last];
  const std::size_t before = requests.size();
  std::erase_if(requests, [&](const BlockRequest& r) {
    if (admitted_[value(r.patch)]) return false;
    const bool waits = area_of(r) + 1 < last || (area_of(r) + 1 == last && room == 0);
    if (!waits && area_of(r) + 1 == last) --room;
    admitted_[value(r.patch)] = !waits;
    return waits;
  });
  return static_cast<std::uint32_t>(before - requests.size());
}

}  // namespace atlaswire::render
