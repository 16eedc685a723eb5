#include "flight/tape.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

namespace haptic::flight {
namespace {

bool append(Tape& tape, std::uint64_t tick, const std::string& bytes) {
  return tape.append({.tick = tick}, bytes);
}

std::string ticks_of(const Tape& tape) {
  std::string ticks;
  for (const Entry& entry : tape.entries()) ticks += std::to_string(entry.tick) + " ";
  return ticks;
}

TEST(Tape, KeepsTheNewestThatFit) {
  Tape tape(10);
  for (std::uint64_t tick = 1; tick <= 5; ++tick) EXPECT_TRUE(append(tape, tick, "abc"));
  EXPECT_EQ(ticks_of(tape), "3 4 5 ");  // three of three bytes
}

TEST(Tape, KeepsWhatItWasGiven) {
  Tape tape(64);
  std::mt19937 random(7);
  std::map<std::uint64_t, std::string> given;
  for (std::uint64_t tick = 0; tick < 2000; ++tick) {
    given[tick] = std::string(random() % 20, static_cast<char>('a' + tick % 26));
    ASSERT_TRUE(append(tape, tick, given[tick]));
    for (const Entry& entry : tape.entries()) ASSERT_EQ(entry.bytes, given[entry.tick]) << tick;
    ASSERT_EQ(tape.entries().back().tick, tick);
  }
}

TEST(Tape, RefusesWhatIsLargerThanItIs) {
  Tape tape(4);
  EXPECT_TRUE(append(tape, 1, "abcd"));
  EXPECT_FALSE(append(tape, 2, "abcde"));
  EXPECT_EQ(ticks_of(tape), "1 ");
}

TEST(Tape, ForgetsWhatIsOlderThanATick) {
  Tape tape(100);
  for (std::uint64_t tick = 1; tick <= 5; ++tick) append(tape, tick, "abc");
  tape.forget_before(4);
  EXPECT_EQ(ticks_of(tape), "4 5 ");
}

TEST(Tape, HoldsWhatIsWrittenAndTakesMoreAsFarAsThereIsRoom) {
  Tape tape(12);
  append(tape, 1, "abc");
  append(tape, 2, "def");
  const std::vector<Entry> held = tape.hold();
  EXPECT_TRUE(append(tape, 3, "ghi"));
  EXPECT_TRUE(append(tape, 4, "jkl"));
  EXPECT_FALSE(append(tape, 5, "mno"));
  tape.forget_before(9);
  EXPECT_EQ(ticks_of(tape), "1 2 3 4 ");
  EXPECT_EQ(held.at(0).bytes, "abc");
  EXPECT_EQ(held.at(1).bytes, "def");
  tape.release();
  EXPECT_TRUE(append(tape, 6, "pqr"));
  EXPECT_EQ(ticks_of(tape), "2 3 4 6 ");
}

TEST(Tape, GoesAroundInFewerBytesWhenItIsToldTo) {
  Tape tape(100);
  for (std::uint64_t tick = 1; tick <= 25; ++tick) append(tape, tick, "abcd");
  tape.use(10);
  for (std::uint64_t tick = 26; tick <= 29; ++tick) EXPECT_TRUE(append(tape, tick, "efgh"));
  EXPECT_EQ(ticks_of(tape), "28 29 ");
  EXPECT_FALSE(append(tape, 30, std::string(11, 'x')));
}

}  // namespace
}  // namespace haptic::flight
