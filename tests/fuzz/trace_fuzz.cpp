#include "base/assert.h"
#include "netsim/bottleneck.h"
#include "netsim/profile.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto model = netsim::parse_trace(text);
  if (!model.has_value()) {
    AW_ASSERT(!model.error().detail.empty());
    return 0;
  }
  AW_ASSERT(!model->trace.empty() && std::is_sorted(model->trace.begin(), model->trace.end()));
  AW_ASSERT(model->trace_period == model->trace.back() && model->trace_period > Duration::zero());
  netsim::Bottleneck bottleneck{Time{}};
  Time last{};
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Time ready = Time{} + model->trace_period / 7 * static_cast<int>(i);
    const std::uint64_t octets = i * 331 % 4000;
    const auto service = bottleneck.plan(*model, ready, octets);
    AW_ASSERT(service && service->start >= ready && service->end >= service->start && service->end >= last);
    last = service->end;
    bottleneck.commit(*model, *service, ready, octets);
  }
  return 0;
}
