#include "rt/tick_clock.h"

#include <gtest/gtest.h>

namespace haptic::rt {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

TEST(TickSchedule, RunsOneTickToEachPeriod) {
  TickSchedule schedule(5000, 1000.0);
  for (std::uint64_t n = 0; n < 10; ++n) {
    const std::int64_t due = 5000 + static_cast<std::int64_t>(n) * kMillisecond;
    EXPECT_EQ(schedule.next_due_ns(), due);
    const Wakeup wakeup = schedule.advance(due + 30);
    EXPECT_EQ(wakeup.tick, n);
    EXPECT_EQ(wakeup.due_ns, due);
    EXPECT_EQ(wakeup.missed, 0u);
    EXPECT_EQ(wakeup.lateness_ns, 30u);
  }
}

TEST(TickSchedule, SkipsAndCountsMissedPeriodsAndKeepsThePhase) {
  TickSchedule schedule(0, 1000.0);
  schedule.advance(0);
  // tick 1 was due at 1 ms; it is 4.3 ms now, so 1, 2 and 3 are gone and 4 runs
  const Wakeup late = schedule.advance(4 * kMillisecond + 300'000);
  EXPECT_EQ(late.tick, 4u);
  EXPECT_EQ(late.missed, 3u);
  EXPECT_EQ(late.due_ns, 4 * kMillisecond);
  EXPECT_EQ(late.lateness_ns, 3'300'000u);
  EXPECT_EQ(schedule.next_due_ns(), 5 * kMillisecond);
  EXPECT_EQ(schedule.advance(5 * kMillisecond).missed, 0u);
}

TEST(TickSchedule, ATickThatIsLateByLessThanAPeriodIsNotMissed) {
  TickSchedule schedule(0, 1000.0);
  const Wakeup late = schedule.advance(kMillisecond - 1);
  EXPECT_EQ(late.tick, 0u);
  EXPECT_EQ(late.missed, 0u);
  const Wakeup exactly_one = TickSchedule(0, 1000.0).advance(kMillisecond);
  EXPECT_EQ(exactly_one.tick, 1u);
  EXPECT_EQ(exactly_one.missed, 1u);
}

TEST(TickSchedule, ARateOfNoWholeNanosecondsDoesNotDrift) {
  // 3000 Hz: 333333.3 ns; three ticks take one millisecond exactly, however long it runs
  TickSchedule schedule(0, 3000.0);
  for (const std::uint64_t n : {3ull, 3'000'000ull, 3'000'000'000ull}) {
    EXPECT_EQ(schedule.due_ns(n), static_cast<std::int64_t>(n / 3) * kMillisecond);
  }
}

TEST(TickSchedule, EveryWakeUpTimeRunsTheLatestTickThatIsDue) {
  for (const double rate : {100.0, 999.0, 1000.0, 3000.0, 7919.0, 8000.0}) {
    for (std::int64_t now = 0; now < 50 * kMillisecond; now += 12'345) {
      TickSchedule schedule(0, rate);
      const Wakeup wakeup = schedule.advance(now);
      ASSERT_LE(schedule.due_ns(wakeup.tick), now);
      ASSERT_GT(schedule.due_ns(wakeup.tick + 1), now);
      ASSERT_EQ(wakeup.missed, wakeup.tick);
    }
  }
}

// No upper bound on lateness is asserted: that is the machine's, not ours.
TEST(TickClock, NeverRunsATickBeforeItIsDue) {
  TickClock clock(1000.0);
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;
  Wakeup wakeup;
  for (int i = 0; i < 20; ++i) {
    wakeup = clock.wait();
    EXPECT_GE(monotonic_ns(), wakeup.due_ns);
    ++ticks;
    missed += wakeup.missed;
  }
  EXPECT_EQ(wakeup.tick + 1, ticks + missed);
}

}  // namespace
}  // namespace haptic::rt
