#include "proto/frame_assembler.h"

#include "proto/refresh_timer.h"
#include "proto/rtp_sender.h"
#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

/// A sender, and an assembler that gets what the test lets through.
class Stream {
 public:
  explicit Stream(const RtpSender::Settings& settings = {}, std::uint32_t first_frame = 0)
      : sender_(settings), next_frame_(first_frame) {}

  /// Packets of the next picture, IDR or not, about `size` octets.
  std::vector<ByteBuffer> make(bool idr, std::size_t size = 5000) {
    const FrameId id{next_frame_++};
    sent_[value(id)] = test::picture(idr, size, random_);
    sender_.packetize({sent_[value(id)], id, PoseId{value(id) + 1}, at(66ms * value(id)), idr}, batch_);
    std::vector<ByteBuffer> out;
    for (std::size_t i = 0; i < batch_.size(); ++i) out.emplace_back(batch_[i].begin(), batch_[i].end());
    return out;
  }
  void give(const ByteBuffer& datagram, Time now) {
    assembler.add(parse_rtp(datagram).value(), datagram.size(), now);
  }
  void give(const std::vector<ByteBuffer>& datagrams, Time now) {
    for (const auto& d : datagrams) give(d, now);
  }
  /// Packets [from, to) of a picture.
  void give_some(const std::vector<ByteBuffer>& datagrams, std::size_t from, std::size_t to, Time now) {
    for (std::size_t i = from; i < to; ++i) give(datagrams[i], now);
  }
  /// Takes every frame that is ready and checks it against what was sent.
  std::vector<std::uint32_t> take() {
    std::vector<std::uint32_t> ids;
    while (const auto frame = assembler.pop()) {
      EXPECT_EQ(frame->access_unit, sent_.at(value(frame->frame)));
      EXPECT_EQ(frame->pose, PoseId{value(frame->frame) + 1});
      EXPECT_EQ(from_ntp(frame->capture), at(66ms * value(frame->frame)));
      ids.push_back(value(frame->frame));
    }
    return ids;
  }

  FrameAssembler assembler;
  Random random_{77};

 private:
  RtpSender sender_;
  std::uint32_t next_frame_;
  DatagramBatch batch_;
  std::map<std::uint32_t, ByteBuffer> sent_;
};

using Ids = std::vector<std::uint32_t>;

TEST(FrameAssembler, GivesFramesInOrderWithTheirStory) {
  Stream s;
  const auto first = s.make(true);
  for (std::size_t i = 0; i < first.size(); ++i) s.give(first[i], at(1ms * i));
  const auto frame = s.assembler.pop();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->idr);
  EXPECT_EQ(frame->packets, first.size());
  EXPECT_EQ(frame->first_arrival, at(0ms));
  EXPECT_EQ(frame->last_arrival, at(1ms * (first.size() - 1)));
  std::uint64_t octets = 0;
  for (const auto& d : first) octets += d.size();
  EXPECT_EQ(frame->octets, octets);
  s.give(s.make(false), at(66ms));
  s.give(s.make(false), at(132ms));
  EXPECT_EQ(s.take(), (Ids{1, 2}));
  EXPECT_FALSE(s.assembler.needs_refresh());
  EXPECT_FALSE(s.assembler.next_deadline());
}

TEST(FrameAssembler, PutsReorderedAndDoubledPacketsRight) {
  Stream s;
  s.give(s.make(true), at(0ms));
  std::vector<ByteBuffer> all;
  for (int n = 0; n < 3; ++n) {
    for (auto& d : s.make(false)) all.push_back(std::move(d));
  }
  std::reverse(all.begin(), all.end());
  std::vector<ByteBuffer> twice = all;
  twice.insert(twice.end(), all.begin(), all.end());
  s.give(twice, at(0ms));
  EXPECT_EQ(s.take(), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(s.assembler.counts().lost, 0U);
  EXPECT_EQ(s.assembler.counts().late, all.size());
}

TEST(FrameAssembler, CountsDuplicatesOfPacketsItHolds) {
  Stream s;
  const auto packets = s.make(true);
  s.give(packets[0], at(0ms));
  s.give(packets[0], at(0ms));
  EXPECT_EQ(s.assembler.counts().duplicates, 1U);
}

TEST(FrameAssembler, WaitsForAGapThenGivesUpTheFrame) {
  Stream s;
  s.give(s.make(true), at(0ms));
  auto broken = s.make(false);
  broken.erase(broken.begin() + 2);
  s.give(broken, at(66ms));
  EXPECT_EQ(s.assembler.next_deadline(), at(96ms));
  s.assembler.poll(at(95ms));
  EXPECT_FALSE(s.assembler.needs_refresh());
  s.assembler.poll(at(96ms));
  EXPECT_TRUE(s.assembler.needs_refresh());
  EXPECT_FALSE(s.assembler.next_deadline());
  EXPECT_EQ(s.take(), (Ids{0}));
  EXPECT_EQ(s.assembler.counts().lost, 1U);
}

TEST(FrameAssembler, AGapFilledInTimeCostsNothing) {
  Stream s;
  s.give(s.make(true), at(0ms));
  const auto packets = s.make(false);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (i != 2) s.give(packets[i], at(66ms));
  }
  s.give(packets[2], at(95ms));
  EXPECT_EQ(s.take(), (Ids{0, 1}));
  EXPECT_FALSE(s.assembler.needs_refresh());
}

TEST(FrameAssembler, WithholdsFramesAfterALossUntilAnIdr) {
  Stream s;
  s.give(s.make(true), at(0ms));
  s.make(false);  // lost whole
  s.give(s.make(false), at(132ms));
  s.assembler.poll(at(200ms));
  s.give(s.make(false), at(200ms));
  EXPECT_EQ(s.take(), (Ids{0}));
  EXPECT_TRUE(s.assembler.needs_refresh());
  s.give(s.make(true), at(266ms));
  s.give(s.make(false), at(333ms));
  EXPECT_EQ(s.take(), (Ids{4, 5}));
  EXPECT_FALSE(s.assembler.needs_refresh());
  EXPECT_EQ(s.assembler.counts().lost, 1U);
  EXPECT_EQ(s.assembler.counts().withheld, 2U);
  EXPECT_EQ(s.assembler.counts().frames, 3U);
}

TEST(FrameAssembler, ALostTailTakesOnlyItsOwnFrame) {
  Stream s;
  s.give(s.make(true), at(0ms));
  auto headless = s.make(false);
  headless.pop_back();
  s.give(headless, at(66ms));
  EXPECT_FALSE(s.assembler.next_deadline());  // nothing beyond it yet
  s.give(s.make(true), at(132ms));
  s.assembler.poll(at(162ms));
  EXPECT_EQ(s.take(), (Ids{0, 2}));
  EXPECT_EQ(s.assembler.counts().lost, 1U);
}

TEST(FrameAssembler, TheRestOfAFrameGivenUpIsNotCountedAgain) {
  Stream s;
  s.give(s.make(true), at(0ms));
  const auto slow = s.make(false, 20'000);
  ASSERT_GT(slow.size(), 10U);
  s.give_some(slow, 0, 2, at(66ms));
  s.give_some(slow, 3, 5, at(67ms));
  s.assembler.poll(at(97ms));
  EXPECT_EQ(s.assembler.counts().lost, 1U);
  s.give_some(slow, 5, slow.size(), at(98ms));
  EXPECT_EQ(s.assembler.counts().lost, 1U);
  s.give(s.make(true), at(132ms));
  EXPECT_EQ(s.take(), (Ids{0, 2}));
}

TEST(FrameAssembler, JoiningMidStreamWaitsForAnIdr) {
  Stream s;
  s.make(true);
  EXPECT_FALSE(s.assembler.needs_refresh());
  s.give(s.make(false), at(66ms));
  EXPECT_TRUE(s.assembler.needs_refresh());
  EXPECT_EQ(s.assembler.counts().withheld, 1U);
  s.give(s.make(true), at(132ms));
  EXPECT_EQ(s.take(), (Ids{2}));
}

TEST(FrameAssembler, JoiningMidFrameLosesThatFrameOnly) {
  Stream s;
  const auto first = s.make(false);
  s.give_some(first, 2, first.size(), at(0ms));
  s.give(s.make(true), at(66ms));
  s.assembler.poll(at(96ms));
  EXPECT_EQ(s.take(), (Ids{1}));
}

TEST(FrameAssembler, TheFirstFramesPacketsMayComeInAnyOrder) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Stream s;
    auto packets = s.make(true);
    Random shuffle(seed);
    for (std::size_t i = packets.size(); i > 1; --i) std::swap(packets[i - 1], packets[shuffle.below(i)]);
    s.give(packets, at(0ms));
    ASSERT_EQ(s.take(), (Ids{0})) << seed;
  }
}

TEST(FrameAssembler, FollowsEveryCounterAroundItsWrap) {
  RtpSender::Settings settings;
  settings.first_sequence = 65500;
  settings.timestamp_base = 0xFFFF'FF00;
  Stream s(settings, 0xFFFF'FFFA);
  Ids expected;
  Ids got;
  for (int n = 0; n < 15000; ++n) {
    expected.push_back(0xFFFF'FFFA + static_cast<std::uint32_t>(n));
    auto packets = s.make(n == 0, 3000);
    std::swap(packets.front(), packets.back());
    s.give(packets, at(66ms * n));
    for (const auto id : s.take()) got.push_back(id);
  }
  EXPECT_EQ(got, expected);
  EXPECT_EQ(s.assembler.counts().lost, 0U);
}

TEST(FrameAssembler, FramesThatTheServerSkippedAreNoLoss) {
  Stream s;
  s.give(s.make(true), at(0ms));
  EXPECT_EQ(s.take(), (Ids{0}));
  // The id jumps, the sequence numbers do not.
  auto packets = s.make(false);
  for (auto& d : packets) d[20] = std::byte{9};  // last octet of the frame id element
  for (const auto& d : packets) ASSERT_EQ(parse_rtp(d).value().header.extensions.frame, FrameId{9});
  s.give(packets, at(66ms));
  const auto frame = s.assembler.pop();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->frame, FrameId{9});
  EXPECT_FALSE(s.assembler.needs_refresh());
}

TEST(FrameAssembler, OneStrayPacketFarAheadIsIgnored) {
  Stream s;
  s.give(s.make(true), at(0ms));
  auto stray = s.make(false);
  stray[0][2] ^= std::byte{0x40};  // 16384 sequence numbers away
  s.give(stray[0], at(1ms));
  EXPECT_EQ(s.assembler.counts().refused, 1U);
  stray[0][2] ^= std::byte{0x40};
  s.give(stray, at(66ms));
  EXPECT_EQ(s.take(), (Ids{0, 1}));
}

TEST(FrameAssembler, ASenderThatRestartsIsFollowed) {
  Stream s;
  s.give(s.make(true), at(0ms));
  EXPECT_EQ(s.take(), (Ids{0}));
  for (const std::uint16_t jump : std::initializer_list<std::uint16_t>{20000, 40000}) {
    RtpSender::Settings settings;
    settings.first_sequence = jump;
    RtpSender again(settings);
    DatagramBatch batch;
    Random random(1);
    for (std::uint32_t n = 0; n < 3; ++n) {
      const ByteBuffer unit = test::picture(n == 2, 5000, random);
      again.packetize({unit, FrameId{100 + n}, PoseId{1}, at(1s), n == 2}, batch);
      for (std::size_t i = 0; i < batch.size(); ++i) {
        s.assembler.add(parse_rtp(batch[i]).value(), batch[i].size(), at(1s + 40ms * n));
      }
    }
    const auto frame = s.assembler.pop();
    ASSERT_TRUE(frame) << jump;
    EXPECT_EQ(frame->frame, FrameId{102});
  }
}

TEST(FrameAssembler, RefusesPacketsWithoutFrameIdOrPayload) {
  FrameAssembler assembler;
  RtpPacketView packet;
  const ByteBuffer payload = test::from_hex("6588");
  packet.payload = payload;
  assembler.add(packet, 14, at(0s));
  packet.header.extensions.frame = FrameId{1};
  packet.payload = {};
  assembler.add(packet, 12, at(0s));
  EXPECT_EQ(assembler.counts().refused, 2U);
  EXPECT_EQ(assembler.counts().packets, 0U);
}

TEST(FrameAssembler, AFrameWithABrokenPayloadIsLost) {
  Stream s;
  s.give(s.make(true), at(0ms));
  auto packets = s.make(false);
  packets[1][24] = std::byte{0x7F};  // a reserved NAL type where an FU-A was
  s.give(packets, at(66ms));
  EXPECT_EQ(s.take(), (Ids{0}));
  EXPECT_EQ(s.assembler.counts().lost, 1U);
  EXPECT_TRUE(s.assembler.needs_refresh());
}

TEST(FrameAssembler, PacketsThatDisagreeMakeNoFrame) {
  for (const std::size_t octet : {4U, 20U}) {  // timestamp, frame id
    Stream s;
    auto packets = s.make(true);
    packets[1][octet] ^= std::byte{1};
    s.give(packets, at(0ms));
    EXPECT_EQ(s.take(), Ids{}) << octet;
    EXPECT_EQ(s.assembler.counts().lost, 1U);
  }
}

TEST(FrameAssembler, TheDecodersFailureClosesTheGate) {
  Stream s;
  s.give(s.make(true), at(0ms));
  s.give(s.make(false), at(66ms));
  s.assembler.require_idr();
  EXPECT_EQ(s.take(), (Ids{0, 1}));  // an IDR is waiting: from it on all is well
  s.assembler.require_idr();
  EXPECT_TRUE(s.assembler.needs_refresh());
  s.give(s.make(false), at(132ms));
  s.give(s.make(true), at(200ms));
  EXPECT_EQ(s.take(), (Ids{3}));
}

TEST(FrameAssembler, HoldsNoMoreThanItsBound) {
  FrameAssembler::Settings settings;
  settings.max_octets = 100'000;
  FrameAssembler assembler(settings);
  RtpPacketView packet;
  const ByteBuffer payload(1000, std::byte{0x41});
  packet.payload = payload;
  for (std::uint16_t i = 0; i < 5000; ++i) {  // a frame that never ends
    packet.header.sequence = i;
    packet.header.extensions.frame = FrameId{1};
    packet.header.extensions.pose = i == 0 ? std::optional(PoseId{1}) : std::nullopt;
    assembler.add(packet, 1024, at(0ms));
  }
  EXPECT_FALSE(assembler.pop());
  EXPECT_GE(assembler.counts().lost, 1U);
  EXPECT_TRUE(assembler.needs_refresh());
}

TEST(FrameAssembler, NobodyPoppingIsBounded) {
  Stream s;
  for (int n = 0; n < 500; ++n) s.give(s.make(true, 500), at(66ms * n));
  EXPECT_LE(s.take().size(), 64U);
  s.give(s.make(true, 500), at(50s));
  EXPECT_EQ(s.take(), (Ids{500}));
}

/// Loss, reordering and duplication by seed: whatever comes out is whole, in order, and decodable.
TEST(FrameAssembler, OnABadPathGivesOnlyWholeDecodableFramesInOrder) {
  struct Arrival {
    Time when;
    ByteBuffer datagram;
  };
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const double loss = seed % 4 == 0 ? 0.0 : 0.002 * static_cast<double>(seed);
    Stream s;
    std::vector<Arrival> arrivals;
    for (int n = 0; n < 200; ++n) {
      for (auto& d : s.make(n % 10 == 0, 3000 + random.below(9000))) {
        if (random.uniform() < loss) continue;
        const int copies = random.uniform() < 0.05 ? 2 : 1;
        for (int c = 0; c < copies; ++c) {
          arrivals.push_back({at(66ms * n) + from_seconds(random.uniform() * 0.025), d});
        }
      }
    }
    std::stable_sort(arrivals.begin(), arrivals.end(),
                     [](const Arrival& a, const Arrival& b) { return a.when < b.when; });
    Ids got;
    for (const auto& arrival : arrivals) {
      if (const auto deadline = s.assembler.next_deadline(); deadline && *deadline <= arrival.when) {
        s.assembler.poll(arrival.when);
      }
      s.give(arrival.datagram, arrival.when);
      for (const auto id : s.take()) got.push_back(id);
    }
    s.assembler.poll(at(1h));
    for (const auto id : s.take()) got.push_back(id);
    for (std::size_t i = 0; i < got.size(); ++i) {
      const bool follows = i > 0 && got[i] == got[i - 1] + 1;
      ASSERT_TRUE(follows || got[i] % 10 == 0) << seed << ": frame " << got[i];
      ASSERT_TRUE(i == 0 || got[i] > got[i - 1]);
    }
    if (loss == 0) {
      ASSERT_EQ(got.size(), 200U) << seed;
      ASSERT_EQ(s.assembler.counts().lost, 0U);
    }
    const auto& counts = s.assembler.counts();
    ASSERT_EQ(counts.frames, got.size());
    ASSERT_LE(counts.frames + counts.withheld + counts.lost, 200U);
    ASSERT_GE(counts.frames + counts.withheld + counts.lost, 199U)
        << seed;  // a lost last frame leaves no trace
  }
}

TEST(RefreshTimer, AsksAtOnceAndThenAgain) {
  RefreshTimer timer;
  EXPECT_FALSE(timer.poll(false, 10ms, at(0s)));
  EXPECT_FALSE(timer.next_deadline());
  EXPECT_TRUE(timer.poll(true, 10ms, at(1s)));
  EXPECT_FALSE(timer.poll(true, 10ms, at(1s + 99ms)));
  EXPECT_EQ(timer.next_deadline(), at(1s + 100ms));
  EXPECT_TRUE(timer.poll(true, 200ms, at(1s + 100ms)));
  EXPECT_EQ(timer.next_deadline(), at(1s + 500ms));
  EXPECT_FALSE(timer.poll(false, 200ms, at(1s + 500ms)));
  EXPECT_FALSE(timer.next_deadline());
  EXPECT_TRUE(timer.poll(true, 200ms, at(1s + 501ms)));
}

}  // namespace
}  // namespace atlaswire::proto
