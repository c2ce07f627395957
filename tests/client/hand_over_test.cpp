#include "client/hand_over.h"

#include "client/bounded_queue.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

namespace atlaswire::client {
namespace {

TEST(HandOver, GivesTheNewestOnce) {
  HandOver<int> h;
  EXPECT_FALSE(h.take());
  EXPECT_FALSE(h.put(1));
  EXPECT_TRUE(h.put(2)) << "nobody took the first";
  EXPECT_EQ(h.take(), 2);
  EXPECT_FALSE(h.take());
  EXPECT_FALSE(h.put(3));
  EXPECT_EQ(h.take(), 3);
}

TEST(HandOver, FreesWhatNobodyTook) {
  HandOver<std::shared_ptr<int>> h;
  const auto first = std::make_shared<int>(1);
  h.put(first);
  h.put(std::make_shared<int>(2));
  EXPECT_EQ(first.use_count(), 1);
}

TEST(HandOver, OrderSurvivesTwoThreads) {
  HandOver<std::unique_ptr<int>> h;
  constexpr int kLast = 20'000;
  std::thread producer([&] {
    for (int i = 1; i <= kLast; ++i) h.put(std::make_unique<int>(i));
  });
  int last = 0;
  while (last < kLast) {
    if (const auto v = h.take()) {
      ASSERT_GT(**v, last);
      last = **v;
    }
  }
  producer.join();
}

TEST(BoundedQueue, RefusesWhenFullAndDrainsWhenClosed) {
  BoundedQueue<int> q(2);
  EXPECT_TRUE(q.try_push(1));
  EXPECT_TRUE(q.try_push(2));
  EXPECT_FALSE(q.try_push(3));
  q.close();
  EXPECT_FALSE(q.try_push(4));
  EXPECT_EQ(q.pop(), 1);
  EXPECT_EQ(q.pop(), 2);
  EXPECT_FALSE(q.pop());
}

TEST(BoundedQueue, ClosingWakesAWaitingThread) {
  BoundedQueue<int> q(1);
  std::thread consumer([&] { EXPECT_FALSE(q.pop()); });
  q.close();
  consumer.join();
}

}  // namespace
}  // namespace atlaswire::client
