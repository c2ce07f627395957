#include "base/emphasis.h"

#include <gtest/gtest.h>

namespace atlaswire {
namespace {

TEST(Emphasis, AWishStandsBeforeWhatIsAlreadyThere) {
  const Emphasis own{.foveation = 1.0, .priorities = {{"floor", -1}, {"lamp", 2}}};
  EXPECT_EQ(over({}, own), own);
  EXPECT_EQ(over(own, {}), own);
  const Emphasis both = over({.foveation = 0.0, .priorities = {{"lamp", 3}}}, own);
  EXPECT_EQ(both.foveation, 0.0) << "0 is an opinion";
  EXPECT_EQ(both.priorities, (std::vector<SurfacePriority>{{"floor", -1}, {"lamp", 2}, {"lamp", 3}}));
}

TEST(ParseSurfacePriority, TakesTheLastEqualsSign) {
  EXPECT_EQ(parse_surface_priority("lamp=1.5"), (SurfacePriority{"lamp", 1.5}));
  EXPECT_EQ(parse_surface_priority("a=b=-8"), (SurfacePriority{"a=b", -8}));
}

TEST(ParseSurfacePriority, RefusesWhatIsNone) {
  for (const char* text :
       {"", "=1", "lamp", "lamp=", "lamp=x", "lamp=1x", "lamp=8.1", "lamp=-9", "lamp=nan"}) {
    EXPECT_FALSE(parse_surface_priority(text)) << text;
  }
  EXPECT_TRUE(parse_surface_priority(std::string(128, 'n') + "=1"));
  EXPECT_FALSE(parse_surface_priority(std::string(129, 'n') + "=1"));
}

}  // namespace
}  // namespace atlaswire
