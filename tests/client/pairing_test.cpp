#include "client/pairing.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace atlaswire::client {
namespace {

using TestPairing = Pairing<std::uint32_t, std::uint32_t>;

/// Pictures and updates carry their frame's number, so that a mixed pair shows.
struct Harness {
  TestPairing pairing;
  std::vector<std::uint32_t> applied;
  std::vector<std::uint32_t> shown;

  explicit Harness(std::size_t pictures = 8, std::size_t updates = 64) : pairing(pictures, updates) {}

  void picture(std::uint32_t n) {
    pairing.add_picture(FrameId{n}, n);
    run();
  }
  bool update(std::uint32_t n) {
    const bool taken = pairing.add_update(FrameId{n}, n);
    run();
    return taken;
  }
  void run() {
    while (auto step = pairing.next_step()) {
      EXPECT_EQ(value(step->frame), step->update);
      applied.push_back(step->update);
      if (!step->picture) continue;
      EXPECT_EQ(*step->picture, step->update) << "a mixed pair";
      shown.push_back(*step->picture);
    }
  }
};

using Ids = std::vector<std::uint32_t>;

TEST(Pairing, PairsWhicheverComesFirst) {
  Harness h;
  h.picture(0);
  EXPECT_TRUE(h.shown.empty());
  h.update(0);
  h.update(1);
  EXPECT_EQ(h.shown, Ids{0});
  h.picture(1);
  EXPECT_EQ(h.shown, (Ids{0, 1}));
}

TEST(Pairing, AppliesUpdatesOfLostFramesInOrderWithoutShowingThem) {
  Harness h;
  for (const std::uint32_t n : {0U, 1U, 2U, 3U}) h.update(n);
  h.picture(0);
  EXPECT_EQ(h.applied, Ids{0}) << "the others wait for their pictures";
  h.picture(3);
  EXPECT_EQ(h.applied, (Ids{0, 1, 2, 3}));
  EXPECT_EQ(h.shown, (Ids{0, 3}));
  EXPECT_EQ(h.pairing.counts().pictureless, 2U);
}

TEST(Pairing, NeverShowsAPictureBehindTheReplica) {
  Harness h;
  h.update(5);
  h.picture(7);
  EXPECT_EQ(h.applied, Ids{5});
  h.picture(6);
  h.update(6);
  EXPECT_EQ(h.applied, (Ids{5, 6}));
  h.update(7);
  EXPECT_EQ(h.shown, Ids{7});
  EXPECT_EQ(h.pairing.counts().late_pictures, 1U);
}

TEST(Pairing, DropsAPictureWhoseUpdateWasNeverSent) {
  Harness h;
  h.update(0);
  h.picture(0);
  h.picture(1);
  h.update(2);
  h.picture(2);
  EXPECT_EQ(h.shown, (Ids{0, 2}));
  EXPECT_EQ(h.pairing.counts().late_pictures, 1U);
}

TEST(Pairing, RefusesUpdatesOutOfOrder) {
  Harness h;
  EXPECT_TRUE(h.update(4));
  EXPECT_FALSE(h.update(4));
  EXPECT_FALSE(h.update(3));
  h.picture(4);
  EXPECT_EQ(h.shown, Ids{4});
}

TEST(Pairing, BoundsWaitingUpdatesByApplyingThem) {
  Harness h(8, 3);
  for (std::uint32_t n = 0; n < 10; ++n) h.update(n);
  EXPECT_EQ(h.pairing.waiting_updates(), 3U);
  EXPECT_EQ(h.applied.size(), 7U);
  h.picture(5);
  EXPECT_TRUE(h.shown.empty()) << "its update has been applied already";
  h.picture(9);
  EXPECT_EQ(h.shown, Ids{9});
}

TEST(Pairing, BoundsWaitingPicturesByDroppingTheOldest) {
  Harness h(2, 64);
  for (std::uint32_t n = 0; n < 5; ++n) h.picture(n);
  EXPECT_EQ(h.pairing.waiting_pictures(), 2U);
  for (std::uint32_t n = 0; n < 5; ++n) h.update(n);
  EXPECT_EQ(h.shown, (Ids{3, 4}));
  EXPECT_EQ(h.applied.size(), 5U);
}

TEST(Pairing, SurvivesTheWrapOfFrameIds) {
  Harness h;
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t n = 0xFFFFFFFDU + i;
    if (i != 3) h.picture(n);
    h.update(n);
  }
  EXPECT_EQ(h.applied.size(), 6U);
  EXPECT_EQ(h.shown, (Ids{0xFFFFFFFDU, 0xFFFFFFFEU, 0xFFFFFFFFU, 1U, 2U}));
}

/// Any interleaving of two in-order channels with losses: updates are applied once each and in order,
/// pictures shown are in order, none mixed; and unless a queue overflowed, every picture that arrived is
/// shown.
TEST(Pairing, NeverMixesInAnyInterleaving) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    Harness h;
    const auto start = static_cast<std::uint32_t>(random.bits());
    const double loss = random.uniform() * 0.6;
    const double lean = 0.1 + 0.8 * random.uniform();
    std::uint32_t next_picture = 0;
    std::uint32_t next_update = 0;
    std::size_t arrived = 0;
    constexpr std::uint32_t kFrames = 60;
    while (next_picture < kFrames || next_update < kFrames) {
      const bool picture_turn = next_update == kFrames || (next_picture < kFrames && random.uniform() < lean);
      if (picture_turn) {
        if (random.uniform() >= loss) {
          h.picture(start + next_picture);
          ++arrived;
        }
        ++next_picture;
      } else {
        ASSERT_TRUE(h.update(start + next_update));
        ++next_update;
      }
      ASSERT_LE(h.pairing.waiting_pictures(), 8U);
    }
    for (std::size_t i = 0; i < h.applied.size(); ++i) ASSERT_EQ(h.applied[i], start + i);
    for (std::size_t i = 1; i < h.shown.size(); ++i) {
      ASSERT_TRUE(is_newer(FrameId{h.shown[i]}, FrameId{h.shown[i - 1]}));
    }
    ASSERT_EQ(h.shown.size() + h.pairing.counts().dropped_pictures + h.pairing.counts().late_pictures,
              arrived);
    ASSERT_EQ(h.pairing.counts().late_pictures, 0U);
  }
}

}  // namespace
}  // namespace atlaswire::client
