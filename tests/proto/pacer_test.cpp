#include "proto/pacer.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

/// `count` datagrams of `size` octets that all hold the frame's number.
DatagramBatch batch_of(std::uint32_t frame, std::size_t count, std::size_t size, bool idr = false) {
  DatagramBatch batch;
  batch.frame = FrameId{frame};
  batch.idr = idr;
  for (std::size_t i = 0; i < count; ++i) {
    batch.octets.resize(batch.octets.size() + size, static_cast<std::byte>(frame));
    batch.ends.push_back(static_cast<std::uint32_t>(batch.octets.size()));
  }
  return batch;
}

PacerVerdict give(Pacer& pacer, DatagramBatch batch, Time now) { return pacer.enqueue(batch, now); }

Pacer::Settings rate_of(std::uint64_t bits_per_second) {
  Pacer::Settings settings;
  settings.rate = BitRate{bits_per_second};
  settings.burst = Bytes{0};
  return settings;
}

/// Runs the pacer by its own deadlines; gives the times of release.
std::vector<Time> run(Pacer& pacer, Time until) {
  std::vector<Time> out;
  while (const auto due = pacer.next_deadline()) {
    if (*due > until) break;
    while (pacer.pop(*due)) out.push_back(*due);
  }
  return out;
}

TEST(Pacer, ReleasesAtItsRate) {
  Pacer pacer(rate_of(8'000'000));  // a datagram of 1000 octets a millisecond
  give(pacer, batch_of(1, 10, 1000), at(5ms));
  EXPECT_EQ(pacer.next_deadline(), at(5ms));
  const auto times = run(pacer, at(1s));
  ASSERT_EQ(times.size(), 10U);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(times[i], at(5ms + 1ms * i));
  EXPECT_EQ(pacer.queued().count, 0U);
  EXPECT_FALSE(pacer.next_deadline());
}

TEST(Pacer, NothingLeavesBeforeItsTime) {
  Pacer pacer(rate_of(8'000'000));
  give(pacer, batch_of(1, 2, 1000), at(0ms));
  EXPECT_TRUE(pacer.pop(at(0ms)));
  EXPECT_FALSE(pacer.pop(at(999us)));
  EXPECT_TRUE(pacer.pop(at(1ms)));
}

TEST(Pacer, ABurstMayLeaveBackToBackAfterAPause) {
  auto settings = rate_of(8'000'000);
  settings.burst = Bytes{3000};
  Pacer pacer(settings);
  give(pacer, batch_of(1, 8, 1000), at(1s));
  const auto times = run(pacer, at(2s));
  ASSERT_EQ(times.size(), 8U);
  EXPECT_EQ(times[3], at(1s));
  EXPECT_EQ(times[4], at(1s + 1ms));
  EXPECT_EQ(times[7], at(1s + 4ms));
}

TEST(Pacer, NoWindowHoldsMoreThanRateAndBurst) {
  Random random(1);
  auto settings = rate_of(20'000'000);
  settings.burst = Bytes{5000};
  settings.max_delay = 10s;
  Pacer pacer(settings);
  std::vector<std::pair<Time, std::size_t>> sent;
  Time now = at(0s);
  for (std::uint32_t n = 0; n < 300; ++n) {
    give(pacer, batch_of(n, 1 + random.below(40), 200 + random.below(1000)), now);
    const Time until = now + from_seconds(random.uniform() * 0.03);
    while (const auto due = pacer.next_deadline()) {
      if (*due > until) break;
      while (const auto datagram = pacer.pop(*due)) sent.emplace_back(*due, datagram->size());
    }
    now = until;
  }
  for (std::size_t i = 0; i < sent.size(); i += 7) {
    std::size_t octets = 0;
    for (std::size_t j = i; j < sent.size(); ++j) {
      octets += sent[j].second;
      const double allowed = to_seconds(sent[j].first - sent[i].first) * 20e6 / 8 + 5000 + 1200;
      ASSERT_LE(static_cast<double>(octets), allowed + 1);
    }
  }
}

TEST(Pacer, AnUnlimitedRateReleasesEverythingAtOnce) {
  auto settings = rate_of(0);
  settings.rate = kUnlimitedRate;
  Pacer pacer(settings);
  for (std::uint32_t n = 0; n < 3; ++n) EXPECT_TRUE(give(pacer, batch_of(n, 100, 1200), at(1s)).accepted);
  EXPECT_EQ(pacer.next_deadline(), at(1s));
  int count = 0;
  while (pacer.pop(at(1s))) ++count;
  EXPECT_EQ(count, 300);
}

TEST(Pacer, AZeroRateReleasesNothingAndKeepsOnePicture) {
  Pacer pacer(rate_of(0));
  EXPECT_TRUE(give(pacer, batch_of(1, 2, 100), at(0s)).accepted);
  EXPECT_FALSE(pacer.next_deadline());
  EXPECT_FALSE(pacer.pop(at(1h)));
  EXPECT_TRUE(give(pacer, batch_of(2, 2, 100), at(1s)).needs_idr());
  const auto idr = give(pacer, batch_of(3, 2, 100, true), at(2s));
  EXPECT_TRUE(idr.accepted);
  EXPECT_EQ(idr.dropped, 1U);
  pacer.set_rate(BitRate{8'000'000}, at(3s));
  EXPECT_EQ(run(pacer, at(4s)).size(), 2U);
}

TEST(Pacer, RefusesAPictureThatWouldWaitTooLongAndSaysSo) {
  auto settings = rate_of(8'000'000);
  settings.max_delay = 20ms;
  Pacer pacer(settings);
  EXPECT_TRUE(give(pacer, batch_of(1, 15, 1000), at(0ms)).accepted);
  DatagramBatch late = batch_of(2, 10, 1000);
  const auto verdict = pacer.enqueue(late, at(0ms));
  EXPECT_TRUE(verdict.needs_idr());
  EXPECT_EQ(late.size(), 10U);  // untouched
  EXPECT_TRUE(give(pacer, batch_of(2, 5, 1000), at(0ms)).accepted);
}

TEST(Pacer, RefusesAPictureOverTheOctetBound) {
  auto settings = rate_of(8'000'000'000);
  settings.max_queued = Bytes{10'000};
  Pacer pacer(settings);
  EXPECT_TRUE(give(pacer, batch_of(1, 100, 1000), at(0ms)).accepted);  // alone: however large
  EXPECT_FALSE(give(pacer, batch_of(2, 1, 1000), at(0ms)).accepted);
  EXPECT_EQ(run(pacer, at(1s)).size(), 100U);
  EXPECT_TRUE(give(pacer, batch_of(3, 1, 1000), at(1s)).accepted);
}

TEST(Pacer, AnIdrReplacesWaitingPicturesButNeverCutsOneThatLeaves) {
  auto settings = rate_of(8'000'000);
  settings.max_delay = 30ms;
  Pacer pacer(settings);
  give(pacer, batch_of(1, 10, 1000), at(0ms));
  give(pacer, batch_of(2, 10, 1000), at(0ms));
  give(pacer, batch_of(3, 10, 1000), at(0ms));
  ASSERT_TRUE(pacer.pop(at(0ms)));
  const auto verdict = give(pacer, batch_of(4, 10, 1000, true), at(0ms));
  EXPECT_TRUE(verdict.accepted);
  EXPECT_EQ(verdict.dropped, 2U);
  std::vector<unsigned> frames;
  while (const auto due = pacer.next_deadline()) {
    const auto datagram = pacer.pop(*due);
    frames.push_back(std::to_integer<unsigned>((*datagram)[0]));
  }
  ASSERT_EQ(frames.size(), 19U);
  EXPECT_EQ(frames[8], 1U);
  EXPECT_EQ(frames[9], 4U);
}

TEST(Pacer, ANewRateHoldsAtOnce) {
  Pacer pacer(rate_of(8'000));  // one datagram of 1000 octets a second
  give(pacer, batch_of(1, 3, 1000), at(0s));
  EXPECT_TRUE(pacer.pop(at(0s)));
  EXPECT_EQ(pacer.next_deadline(), at(1s));
  pacer.set_rate(BitRate{8'000'000}, at(0s));
  EXPECT_EQ(pacer.next_deadline(), at(1ms));
}

TEST(Pacer, ClearTellsWhatWasNotSentWhole) {
  Pacer pacer(rate_of(8'000'000));
  give(pacer, batch_of(1, 2, 1000), at(0ms));
  give(pacer, batch_of(2, 2, 1000), at(0ms));
  pacer.pop(at(0ms));
  EXPECT_EQ(pacer.clear(), 2U);
  EXPECT_EQ(pacer.queued().count, 0U);
  EXPECT_FALSE(pacer.next_deadline());
}

TEST(Pacer, GivesBuffersBack) {
  auto settings = rate_of(0);
  settings.rate = kUnlimitedRate;
  Pacer pacer(settings);
  DatagramBatch batch = batch_of(1, 10, 1000);
  const auto* octets = batch.octets.data();
  bool came_back = false;
  for (std::uint32_t n = 0; n < 4; ++n) {
    pacer.enqueue(batch, at(0s));
    while (pacer.pop(at(0s))) {
    }
    EXPECT_EQ(batch.size(), 0U);
    came_back |= batch.octets.data() == octets && batch.octets.capacity() >= 10'000;
    const DatagramBatch fill = batch_of(n, 10, 1000);
    batch.octets.assign(fill.octets.begin(), fill.octets.end());
    batch.ends = fill.ends;
  }
  EXPECT_TRUE(came_back);
}

TEST(Pacer, AnEmptyPictureIsNothing) {
  Pacer pacer(rate_of(8'000'000));
  EXPECT_TRUE(give(pacer, {}, at(0s)).accepted);
  EXPECT_EQ(pacer.queued_pictures(), 0U);
}

}  // namespace
}  // namespace atlaswire::proto
