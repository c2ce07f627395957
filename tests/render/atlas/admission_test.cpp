#include "render/atlas/admission.h"

#include "tests/render/atlas/layout_checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace atlaswire::render {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::uint32_t> admitted(Admission& admission, std::vector<BlockRequest> requests) {
  const std::size_t asked = requests.size();
  const std::uint32_t waiting = admission.admit(requests);
  EXPECT_EQ(waiting, asked - requests.size());
  std::vector<std::uint32_t> patches;
  for (const BlockRequest& r : requests) patches.push_back(value(r.patch));
  return patches;
}

/// Two large blocks among small ones.
std::vector<BlockRequest> mixed() {
  return {request(0, 1, 1), request(1, 5, 5), request(2, 2, 2),
          request(3, 3, 1), request(4, 6, 4), request(5, 1, 1)};
}

TEST(Admission, LetsTheLargestInFirstAndTheRestLater) {
  Admission admission(2, 6);
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(1, 4));
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(1, 2, 3, 4)) << "of equal areas: 2x2 and 3x1";
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Admission, OfEqualAreasTheLowestNumbersGoFirst) {
  Admission admission(3, 6);
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(1, 2, 4));
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Admission, WhoWasAdmittedMayAlwaysComeBack) {
  Admission admission(3, 6);
  admitted(admission, mixed());
  EXPECT_THAT(admitted(admission, {}), IsEmpty());
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(0, 1, 2, 3, 4, 5)) << "three of them are known";
}

TEST(Admission, BeginsAnewAfterARestart) {
  Admission admission(3, 6);
  admitted(admission, mixed());
  admission.restart();
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(1, 2, 4));
}

TEST(Admission, WithoutALimitNobodyWaits) {
  Admission admission(0, 6);
  EXPECT_THAT(admitted(admission, mixed()), ElementsAre(0, 1, 2, 3, 4, 5));
  admission.restart();
}

}  // namespace
}  // namespace atlaswire::render
