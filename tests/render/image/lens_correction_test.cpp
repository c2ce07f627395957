#include "render/image/lens_correction.h"

#include <gtest/gtest.h>

namespace atlaswire::render {
namespace {

TEST(ParseLens, ReadsNamesAndCoefficients) {
  EXPECT_EQ(parse_lens("none").value(), LensCorrection{});
  EXPECT_NE(parse_lens("generic").value(), LensCorrection{});
  const LensCorrection two = parse_lens("0.25,-0.5").value();
  for (const RadialCorrection& channel : two.channels) EXPECT_EQ(channel, (RadialCorrection{0.25, -0.5}));
  const LensCorrection six = parse_lens("1,2,3,4,5,1e-1").value();
  EXPECT_EQ(six.channels[0], (RadialCorrection{1, 2}));
  EXPECT_EQ(six.channels[1], (RadialCorrection{3, 4}));
  EXPECT_EQ(six.channels[2], (RadialCorrection{5, 0.1}));
}

TEST(ParseLens, GenericShrinksBlueMostAndRedLeast) {
  const auto k = parse_lens("generic").value().channels;
  EXPECT_LT(k[0].k1, k[1].k1);
  EXPECT_LT(k[1].k1, k[2].k1);
}

TEST(ParseLens, RefusesOtherTexts) {
  for (const char* text : {"", "fisheye", "1", "1,2,3", "1,2,3,4,5,6,7,8", "1,,2", "1,2,", ",1,2", "1, 2",
                           "nan,0", "inf,0", "11,0", "0,-11", "1;2"}) {
    const auto lens = parse_lens(text);
    ASSERT_TRUE(lens.has_error()) << text;
    EXPECT_EQ(lens.error().code, make_error_code(LensError::kBadLens));
  }
}

TEST(ParseLens, ReadsItsOwnText) {
  for (const char* text : {"none", "generic", "0.1,0,0.30000000000000004,-2,1e-07,10"}) {
    EXPECT_EQ(to_string(parse_lens(text).value()), text);
  }
  EXPECT_EQ(to_string(parse_lens("0.5,0").value()), "0.5,0,0.5,0,0.5,0");
}

}  // namespace
}  // namespace atlaswire::render
