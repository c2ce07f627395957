#include "codec/flat_index.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <unordered_map>

namespace atlaswire::codec {
namespace {

TEST(FlatIndex, AnswersAsAMapDoes) {
  Random random(5);
  FlatIndex index(9);
  std::unordered_map<std::uint64_t, std::uint32_t> truth;
  for (std::uint32_t step = 0; step < 60'000; ++step) {
    // Few keys, so that erasures and insertions meet; the phases shrink and grow it.
    const std::uint64_t key = random.below(3000);
    const bool grows = step / 10'000 % 2 == 0;
    const auto found = truth.find(key);
    ASSERT_EQ(index.find(key), found == truth.end() ? FlatIndex::kNone : found->second);
    if (found == truth.end()) {
      if (grows || random.below(4) == 0) {
        index.insert(key, step);
        truth[key] = step;
      }
    } else if (!grows || random.below(4) == 0) {
      index.erase(key);
      truth.erase(found);
    }
    ASSERT_EQ(index.size(), truth.size());
  }
  for (const auto& [key, value] : truth) ASSERT_EQ(index.find(key), value);
  index.clear();
  EXPECT_EQ(index.find(truth.begin()->first), FlatIndex::kNone);
}

}  // namespace
}  // namespace atlaswire::codec
