#include "client/decode_thread.h"

#include "codec/motion.h"
#include "tests/client/synthetic_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace atlaswire::client {
namespace {

using ::testing::HasSubstr;
using testing::square_stream;
using testing::SquareServer;

struct DecodeThreadTest : ::testing::Test {
  SquareServer server;
  ArrivalQueue arrivals{kArrivalPlaces};
  HandOver<Pair> pairs;
  int idrs_wanted = 0;
  std::string broken;
  std::vector<FrameId> restarts;
  std::optional<proto::MotionDescription> motion;

  DecodeCounts run(std::vector<Arrival> input) {
    for (Arrival& a : input) EXPECT_TRUE(arrivals.try_push(std::move(a)));
    arrivals.close();
    proto::StreamDescription stream = square_stream();
    stream.meta_codec = static_cast<std::uint32_t>(server.meta_codec());
    stream.motion = motion;
    DecodeThread decoder(stream, {}, arrivals, pairs,
                         {.decode_failed = [this] { ++idrs_wanted; },
                          .peer_broke = [this](std::string why) { broken = std::move(why); },
                          .out_of_step = [this](FrameId f, const std::string&) { restarts.push_back(f); }});
    decoder.finish();
    return decoder.counts();
  }

  template <class... A>
  static std::vector<Arrival> list(A... arrivals_in) {
    std::vector<Arrival> all;
    (all.push_back(std::move(arrivals_in)), ...);
    return all;
  }
};

Arrival garbage_picture(std::uint32_t n) {
  auto frame = std::make_unique<proto::AssembledFrame>();
  frame->frame = FrameId{n};
  frame->access_unit = {std::byte{0}, std::byte{0},    std::byte{0},
                        std::byte{1}, std::byte{0x41}, std::byte{0xFF}};
  return {.frame = std::move(frame), .update = nullptr};
}

TEST_F(DecodeThreadTest, HandsOverTheNewestPair) {
  const DecodeCounts c = run(list(server.update(0, true), server.picture(0, 90, true),
                                  server.picture(1, 120, false), server.update(1, false)));
  EXPECT_EQ(c.decoded, 2U);
  EXPECT_EQ(c.pairing.paired, 2U);
  EXPECT_EQ(c.never_shown, 1U);
  EXPECT_EQ(c.patches, 1U);
  const auto pair = pairs.take();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->times.frame, FrameId{1});
  EXPECT_EQ(pair->mesh.indices.size(), 6U);
  EXPECT_NEAR(pair->picture->view().y[0], 120, 3);
  EXPECT_GE(pair->times.ready, pair->times.video_arrival);
  EXPECT_EQ(broken, "");
}

/// The square as a rigid object that goes up a metre a frame; its messages begin anew at frame 0 and at
/// `restart`.
struct MovingSquare {
  explicit MovingSquare(std::uint32_t restart = 0)
      : description{.movers = {{0, 1, false, 0}},
                    .pivots = {{0, 0, 0}},
                    .translation_step = square_stream().grid.step} {
    codec::MotionEncoder encoder(
        {square_stream().grid, {.step = description.translation_step, .rotation_bits = 14}});
    const std::uint32_t object = 0;
    for (std::uint32_t n = 0; n < 5; ++n) {
      const codec::RigidTransform up{.translation = {0, n, 0}};
      encoder
          .encode({nullptr, {}, std::span(&object, 1)},
                  {.reset = n == 0 || n == restart, .transforms = std::span(&up, 1)}, messages.emplace_back())
          .value();
    }
  }
  [[nodiscard]] Arrival with_motion(Arrival arrival, std::uint32_t n) const {
    arrival.update->update.meta.motion = messages[n];
    return arrival;
  }
  proto::MotionDescription description;
  std::vector<ByteBuffer> messages;
};

double highest(const Pair& pair) {
  double y = -1e9;
  for (const auto& vertex : pair.mesh.vertices) y = std::max<double>(y, vertex.position.y + pair.origin.y);
  return y;
}

TEST_F(DecodeThreadTest, ShowsEachPictureWithWhatMovesWhereItWasThen) {
  MovingSquare square;
  motion = square.description;
  run(list(square.with_motion(server.update(0, true), 0), server.picture(0, 90, true),
           server.picture(1, 90, false), square.with_motion(server.update(1, false), 1),
           // The picture of 2 is lost: its motion counts all the same. That of 4 is not there yet.
           square.with_motion(server.update(2, false), 2), square.with_motion(server.update(3, false), 3),
           server.picture(3, 90, false), square.with_motion(server.update(4, false), 4)));
  EXPECT_EQ(broken, "");
  EXPECT_TRUE(restarts.empty());
  const auto pair = pairs.take();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->times.frame, FrameId{3});
  EXPECT_NEAR(highest(*pair), 1 + 3, 2 * square_stream().grid.max_error());
}

TEST_F(DecodeThreadTest, LostMotionIsNotShownAndAskedForOnce) {
  MovingSquare square;
  motion = square.description;
  std::vector<Arrival> input =
      list(square.with_motion(server.update(0, true), 0), server.picture(0, 90, true),
           square.with_motion(server.update(1, false), 1), server.picture(1, 90, false),
           square.with_motion(server.update(2, false), 2), server.picture(2, 90, false));
  input[2].update->update.meta.motion.pop_back();
  const DecodeCounts c = run(std::move(input));
  EXPECT_EQ(broken, "");
  ASSERT_EQ(restarts.size(), 1U);
  EXPECT_EQ(restarts[0], FrameId{1});
  EXPECT_EQ(c.restarts, 1U);
  EXPECT_EQ(pairs.take()->times.frame, FrameId{0});
}

TEST_F(DecodeThreadTest, ARestartFindsLostMotionAgain) {
  MovingSquare square(2);
  motion = square.description;
  std::vector<Arrival> input =
      list(square.with_motion(server.update(0, true), 0), server.picture(0, 90, true),
           square.with_motion(server.update(1, false), 1), server.picture(1, 90, false),
           square.with_motion(server.update(2, true), 2), server.picture(2, 90, true));
  input[2].update->update.meta.motion.clear();
  run(std::move(input));
  EXPECT_EQ(restarts.size(), 1U);
  const auto pair = pairs.take();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->times.frame, FrameId{2});
  EXPECT_NEAR(highest(*pair), 1 + 2, 2 * square_stream().grid.max_error());
}

TEST_F(DecodeThreadTest, MotionOfAStreamThatRestsBreaksTheSession) {
  std::vector<Arrival> input = list(server.update(0, true), server.picture(0, 90, true));
  input[0].update->update.meta.motion = {std::byte{0xB3}};
  run(std::move(input));
  EXPECT_THAT(broken, HasSubstr("nothing moves"));
}

TEST_F(DecodeThreadTest, AsksForAnIdrAfterGarbageAndSkipsUntilItComes) {
  const DecodeCounts c =
      run(list(server.update(0, true), server.picture(0, 90, true), garbage_picture(1),
               server.update(1, false), server.picture(2, 100, false), server.update(2, false),
               server.picture(3, 150, true), server.update(3, false)));
  EXPECT_EQ(idrs_wanted, 1);
  EXPECT_EQ(c.failed, 1U);
  EXPECT_EQ(c.skipped, 1U);
  EXPECT_EQ(pairs.take()->times.frame, FrameId{3});
}

TEST_F(DecodeThreadTest, EndsTheSessionWhenAnUpdateIsMalformed) {
  Arrival bad = server.update(0, true);
  bad.update->update.meta.meta.resize(5);
  run(list(std::move(bad)));
  EXPECT_THAT(broken, HasSubstr("meta update 0"));
}

TEST_F(DecodeThreadTest, EndsTheSessionWhenAnUpdateContradictsTheReplica) {
  auto twice = server.update(1, true);
  Arrival first = server.update(0, true);
  codec::MetaUpdate again = testing::square_update(FrameId{1}, true);
  again.reset = false;
  twice.update->update.meta.meta.clear();
  codec::make_meta_encoder(codec::MetaCodecKind::kPlain, testing::square_limits())
      ->encode(again, twice.update->update.meta.meta);
  run(list(std::move(first), server.picture(0, 90, true), std::move(twice), server.picture(1, 90, false)));
  EXPECT_THAT(broken, HasSubstr("already"));
  EXPECT_EQ(pairs.take()->times.frame, FrameId{0}) << "the last good pair stays";
}

/// The same with a meta codec that keeps state.
struct OutOfStepTest : DecodeThreadTest {
  OutOfStepTest() { server = SquareServer(codec::MetaCodecKind::kGate); }
  Arrival bent(std::uint32_t n) {
    Arrival update = server.update(n, false);
    for (std::byte& octet : update.update->update.meta.meta) octet ^= std::byte{0x10};
    update.update->update.meta.meta[0] ^= std::byte{0x10};
    return update;
  }
};

TEST_F(OutOfStepTest, AsksOnceAndGoesOnFromTheRestart) {
  std::vector<Arrival> input;
  for (std::uint32_t n = 0; n < 5; ++n) {
    const bool restart = n == 0 || n == 3;
    input.push_back(n == 1 ? bent(n) : server.update(n, restart));
    input.push_back(server.picture(n, static_cast<std::uint8_t>(90 + n), restart));
  }
  const DecodeCounts c = run(std::move(input));
  EXPECT_EQ(restarts, std::vector<FrameId>{FrameId{1}});
  EXPECT_EQ(broken, "");
  EXPECT_EQ(c.restarts, 1U);
  EXPECT_EQ(c.pairing.paired, 3U) << "0, 3 and 4: what lies between is not shown";
  EXPECT_EQ(pairs.take()->times.frame, FrameId{4});
}

TEST_F(OutOfStepTest, KeepsTheLastGoodPairMeanwhile) {
  std::vector<Arrival> input = list(server.update(0, true), server.picture(0, 90, true));
  input.push_back(bent(1));
  input.push_back(server.picture(1, 100, false));
  run(std::move(input));
  EXPECT_EQ(pairs.take()->times.frame, FrameId{0});
}

TEST_F(OutOfStepTest, GivesUpOnAServerThatRestartsInVain) {
  std::vector<Arrival> input;
  for (std::uint32_t n = 0; n < 20; n += 2) {
    input.push_back(server.update(n, true));
    input.push_back(bent(n + 1));
  }
  run(std::move(input));
  EXPECT_EQ(restarts.size(), 4U);
  EXPECT_THAT(broken, HasSubstr("meta update 9"));
}

TEST_F(DecodeThreadTest, EndsTheSessionWhenFrameNumbersDisagree) {
  Arrival wrong = server.update(0, true);
  wrong.update->update.meta.frame = FrameId{4};
  run(list(std::move(wrong)));
  EXPECT_THAT(broken, HasSubstr("in the message of frame 4"));
}

}  // namespace
}  // namespace atlaswire::client
