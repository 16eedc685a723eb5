#include "client/cli/describe.h"

#include <gtest/gtest.h>

#include <set>

#include "client/cli/advice.h"

namespace haptic::cli {
namespace {

TEST(Describe, WritesDurationsInTwoUnits) {
  EXPECT_EQ(duration(12.9), "12 s");
  EXPECT_EQ(duration(60.0), "1 min 00 s");
  EXPECT_EQ(duration(3720.0), "1 h 02 min");
  EXPECT_EQ(duration(90000.0), "1 d 01 h");
}

TEST(Describe, ChoosesTheUnitOfATime) {
  EXPECT_EQ(nanoseconds(740.0), "740 ns");
  EXPECT_EQ(nanoseconds(12'340.0), "12.3 us");
  EXPECT_EQ(nanoseconds(1'204'000.0), "1.20 ms");
}

TEST(Describe, WritesMillimetresWithoutNegativeZero) {
  EXPECT_EQ(millimetres(0.0123456), "+12.35");
  EXPECT_EQ(millimetres(-0.0000001), "+0.00");
  EXPECT_EQ(millimetres(-0.001), "-1.00");
}

TEST(Describe, TellsAFaultWithItsNumbers) {
  v1::Fault fault;
  fault.set_kind(v1::FAULT_OVER_SPEED);
  fault.set_device("left");
  fault.set_tick(9);
  fault.set_value(2.314);
  fault.set_limit(2.0);
  EXPECT_EQ(describe(fault), "left: over speed, 2.31 m/s where 2 m/s is allowed (tick 9)");
}

TEST(Describe, TellsWhatToDoAboutEachFaultOfTheSchema) {
  std::set<std::string> told;
  for (int kind = v1::FAULT_NONE + 1; kind <= v1::FaultKind_MAX; ++kind) {
    told.insert(advise(static_cast<v1::FaultKind>(kind)));
  }
  EXPECT_EQ(told.size(), static_cast<std::size_t>(v1::FaultKind_MAX)) << "each has its own";
  EXPECT_EQ(told.count(advise(static_cast<v1::FaultKind>(77))), 0U);
}

TEST(Describe, TellsASideOfABoxEvenIfItIsNegative) {
  v1::Fault fault;
  fault.set_kind(v1::FAULT_OVER_TRAVEL);
  fault.set_device("left");
  fault.set_tick(9);
  fault.set_value(-0.115);
  fault.set_limit(-0.1);
  EXPECT_EQ(describe(fault), "left: over travel, -0.115 m where -0.1 m is allowed (tick 9)");
}

TEST(Describe, EachKindOfFaultHasItsWords) {
  for (const v1::FaultKind kind : {v1::FAULT_ENERGY, v1::FAULT_EMERGENCY_STOP, v1::FAULT_STILL_SAMPLE}) {
    EXPECT_EQ(describe(kind).find("fault "), std::string::npos) << kind;
  }
}

TEST(Describe, SaysWhenThereIsNoRealTime) {
  v1::RealTime none;
  EXPECT_EQ(describe(none), "no real-time priority, memory not locked");
  none.set_fifo(true);
  none.set_priority(80);
  none.set_cpu(1);
  none.set_memory_locked(true);
  EXPECT_EQ(describe(none), "SCHED_FIFO 80, cpu 1, memory locked");
}

}  // namespace
}  // namespace haptic::cli
