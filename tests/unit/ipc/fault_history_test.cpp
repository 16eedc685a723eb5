#include "ipc/fault_history.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

v1::Fault fault_at(std::uint64_t tick, v1::FaultKind kind = v1::FAULT_OVER_SPEED) {
  v1::Fault fault;
  fault.set_kind(kind);
  fault.set_tick(tick);
  return fault;
}

TEST(FaultHistory, TellsWhatWasLatchedAndWhen) {
  FaultHistory history;
  history.add(fault_at(7), 1000, 2000);
  ASSERT_EQ(history.list().fault_size(), 1);
  EXPECT_EQ(history.list().fault(0).fault().tick(), 7U);
  EXPECT_EQ(history.list().fault(0).monotonic_ns(), 1000U);
  EXPECT_EQ(history.list().fault(0).realtime_ns(), 2000U);
  EXPECT_TRUE(history.list().fault(0).latched());
}

TEST(FaultHistory, RemembersWhatIsCleared) {
  FaultHistory history;
  history.add(fault_at(7), 0, 0);
  history.clear();
  history.add(fault_at(9), 0, 0);
  EXPECT_FALSE(history.list().fault(0).latched());
  EXPECT_TRUE(history.list().fault(1).latched());
}

TEST(FaultHistory, KeepsTheLastHundredAndCountsAll) {
  FaultHistory history;
  for (std::uint64_t tick = 0; tick < 130; ++tick) {
    history.add(fault_at(tick, tick < 10 ? v1::FAULT_NOT_FINITE : v1::FAULT_OVER_SPEED), 0, 0);
  }
  EXPECT_EQ(history.list().fault_size(), 100);
  EXPECT_EQ(history.list().fault(0).fault().tick(), 30U);
  EXPECT_EQ(history.list().fault(99).fault().tick(), 129U);
  EXPECT_EQ(history.counts().at(v1::FAULT_NOT_FINITE), 10U);
  EXPECT_EQ(history.counts().at(v1::FAULT_OVER_SPEED), 120U);
}

TEST(FaultHistory, TellsTheRecordingOfEachThatIsStillKept) {
  FaultHistory history;
  const std::uint64_t dropped = history.add(fault_at(0), 0, 0);
  std::vector<std::uint64_t> numbers = {dropped};
  for (std::uint64_t tick = 1; tick <= 100; ++tick) numbers.push_back(history.add(fault_at(tick), 0, 0));
  history.set_recording({dropped, numbers[1], numbers[100]}, "/f.mcap");
  EXPECT_EQ(history.list().fault(0).recording(), "/f.mcap");
  EXPECT_EQ(history.list().fault(1).recording(), "");
  EXPECT_EQ(history.list().fault(99).recording(), "/f.mcap");
}

}  // namespace
}  // namespace haptic::ipc
