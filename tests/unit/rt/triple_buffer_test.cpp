#include "rt/triple_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

namespace haptic::rt {
namespace {

TEST(TripleBuffer, ShowsTheInitialValueUntilSomethingIsPublished) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.latest(), 7);
  EXPECT_EQ(TripleBuffer<int>().latest(), 0);
}

TEST(TripleBuffer, GivesTheNewestValueAndForgetsTheOnesBefore) {
  TripleBuffer<int> buffer;
  buffer.write(1);
  buffer.write(2);
  buffer.write(3);
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.latest(), 3);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.latest(), 3);
}

TEST(TripleBuffer, LeavesWhatTheReaderLooksAtAlone) {
  TripleBuffer<int> buffer;
  buffer.write(1);
  ASSERT_TRUE(buffer.update());
  const int& seen = buffer.latest();
  for (int i = 2; i < 10; ++i) buffer.write(i);
  EXPECT_EQ(seen, 1);
}

TEST(TripleBuffer, HidesWhatIsNotYetPublished) {
  TripleBuffer<int> buffer;
  buffer.writable() = 5;
  EXPECT_FALSE(buffer.update());
  buffer.publish();
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.latest(), 5);
}

// Every value is an array of equal numbers, so that a torn one would show; numbers ascend, so that one that
// is older than the last would show; and the last one is always seen in the end.
TEST(TripleBuffer, NeverTearsNorGoesBackBetweenTwoThreads) {
  using Value = std::array<std::uint64_t, 64>;
  constexpr std::uint64_t kLast = 50000;
  TripleBuffer<Value> buffer;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      buffer.writable().fill(i);
      buffer.publish();
    }
  });
  std::uint64_t newest = 0;
  while (newest < kLast) {
    if (!buffer.update()) {
      std::this_thread::yield();
      continue;
    }
    const Value& value = buffer.latest();
    ASSERT_GT(value[0], newest);
    newest = value[0];
    for (const std::uint64_t number : value) ASSERT_EQ(number, newest);
  }
  writer.join();
  EXPECT_FALSE(buffer.update());
}

}  // namespace
}  // namespace haptic::rt
