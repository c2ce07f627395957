#include "proto/clock_sync.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

constexpr SessionId kSession{5};

/// One exchange over a path with the given one-way delays, with the server's clock `offset` ahead.
bool exchange(ClockSync& sync, Time now, Duration offset, Duration up, Duration down) {
  const auto request = sync.poll(now);
  if (!request) return false;
  const auto response = answer_sync(*request, now + up + offset, now + up + offset + 1ms);
  return sync.on_response(response, now + up + 1ms + down);
}

TEST(ClockSync, FindsOffsetAndRoundTripOnASymmetricPath) {
  ClockSync sync(kSession);
  EXPECT_FALSE(sync.is_synchronized());
  EXPECT_EQ(sync.error_bound(at(0s)), Duration::max());
  EXPECT_TRUE(exchange(sync, at(0s), -3h, 20ms, 20ms));
  EXPECT_TRUE(sync.is_synchronized());
  EXPECT_EQ(sync.offset(), Duration(-3h));
  EXPECT_EQ(sync.round_trip(), Duration(40ms));
  EXPECT_EQ(sync.to_server(at(5h)), to_nanos(at(2h)));
  EXPECT_EQ(sync.to_client(to_nanos(at(2h))), at(5h));
}

TEST(ClockSync, AnAsymmetricPathErrsByHalfTheDifference) {
  ClockSync sync(kSession);
  exchange(sync, at(0s), 1s, 30ms, 10ms);
  EXPECT_EQ(sync.offset(), Duration(1s + 10ms));
  EXPECT_GE(sync.error_bound(at(41ms)), Duration(10ms));
}

TEST(ClockSync, TheLeastRoundTripCounts) {
  ClockSync sync(kSession);
  exchange(sync, at(0ms), 1s, 50ms, 10ms);
  exchange(sync, at(100ms), 1s, 10ms, 10ms);
  exchange(sync, at(200ms), 1s, 10ms, 90ms);
  EXPECT_EQ(sync.offset(), Duration(1s));
  EXPECT_EQ(sync.round_trip(), Duration(20ms));
  EXPECT_EQ(sync.last_round_trip(), Duration(100ms));
}

TEST(ClockSync, TheErrorStaysWithinItsBoundUnderJitterAndDrift) {
  Random random(11);
  ClockSync sync(kSession);
  constexpr double kDrift = 40e-6;
  for (int i = 0; i < 3000; ++i) {
    const Time now = at(100ms * i);
    const auto offset = [&](Time t) {
      return Duration(7s) + from_seconds(to_seconds(t.time_since_epoch()) * kDrift);
    };
    const Duration up = 5ms + from_seconds(random.uniform() * 0.03);
    const Duration down = 5ms + from_seconds(random.uniform() * 0.03);
    exchange(sync, now, offset(now), up, down);
    const Duration error = sync.offset() - offset(now);
    ASSERT_LE(std::abs(error.count()), sync.error_bound(now).count()) << i;
    if (i > 300) {
      ASSERT_LT(std::abs(error.count()), 15'000'000);
    }
  }
}

TEST(ClockSync, ForgetsSamplesThatLeaveTheWindow) {
  ClockSync sync(kSession);
  exchange(sync, at(0s), 1s, 1ms, 1ms);
  for (int i = 1; i <= 40; ++i) exchange(sync, at(1s * i), 2s, 10ms, 10ms);
  EXPECT_EQ(sync.round_trip(), Duration(20ms));
  EXPECT_EQ(sync.offset(), Duration(2s));
}

TEST(ClockSync, AsksFastFirstThenSlowly) {
  ClockSync sync(kSession);
  Time now = at(0s);
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE(exchange(sync, now, 1s, 1ms, 1ms));
    now += 50ms;
  }
  EXPECT_FALSE(sync.poll(now - 1ns));
  EXPECT_TRUE(exchange(sync, now, 1s, 1ms, 1ms));
  EXPECT_EQ(sync.next_deadline(), now + 1s);
}

TEST(ClockSync, RefusesAnswersThatCannotBe) {
  ClockSync sync(kSession);
  const auto request = *sync.poll(at(100ms));
  const auto response = [&](Duration in, Duration out) { return answer_sync(request, at(in), at(out)); };
  SyncResponse wrong = response(1s, 1s);
  wrong.session = SessionId{6};
  EXPECT_FALSE(sync.on_response(wrong, at(200ms)));
  wrong = response(1s, 1s);
  wrong.sequence += 1;
  EXPECT_FALSE(sync.on_response(wrong, at(200ms)));
  wrong = response(1s, 1s);
  wrong.client_sent += 1;
  EXPECT_FALSE(sync.on_response(wrong, at(200ms)));
  EXPECT_FALSE(sync.on_response(response(1s, 1s), at(99ms)));           // before we asked
  EXPECT_FALSE(sync.on_response(response(1s, 999ms), at(200ms)));       // sent before it received
  EXPECT_FALSE(sync.on_response(response(1s, 1s + 101ms), at(200ms)));  // held it longer than it took
  EXPECT_FALSE(sync.is_synchronized());
  EXPECT_TRUE(sync.on_response(response(1s, 1s), at(200ms)));
  EXPECT_FALSE(sync.on_response(response(1s, 1s), at(200ms)));  // a duplicate
}

TEST(ClockSync, SurvivesAServerThatNeverAnswers) {
  ClockSync sync(kSession);
  std::optional<SyncRequest> last;
  for (int i = 0; i < 1000; ++i) last = sync.poll(at(50ms * i));
  ASSERT_TRUE(last);
  EXPECT_TRUE(sync.on_response(answer_sync(*last, at(1s), at(1s)), at(50ms * 1000)));
}

}  // namespace
}  // namespace atlaswire::proto
