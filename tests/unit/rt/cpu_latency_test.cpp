#include "rt/cpu_latency.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace haptic::rt {
namespace {

// 32 bits of 0, and not the text "0", which the kernel would read as a number in hexadecimal
TEST(CpuLatency, WritesZeroMicrosecondsAndHoldsTheNodeOpen) {
  const test::TemporaryFolder folder;
  CpuLatency latency(folder.write("node", ""));
  EXPECT_FALSE(latency.is_held());
  EXPECT_EQ(latency.hold(), "");
  EXPECT_TRUE(latency.is_held());
  EXPECT_EQ(folder.read("node"), std::string(4, '\0'));
  EXPECT_EQ(latency.hold(), "");
  EXPECT_EQ(folder.read("node"), std::string(4, '\0')) << "it is written once";
}

TEST(CpuLatency, CanBeReleasedAndHeldAgain) {
  const test::TemporaryFolder folder;
  CpuLatency latency(folder.write("node", ""));
  latency.release();
  EXPECT_EQ(latency.hold(), "");
  latency.release();
  EXPECT_FALSE(latency.is_held());
  EXPECT_EQ(latency.hold(), "");
  EXPECT_TRUE(latency.is_held());
}

TEST(CpuLatency, TellsOnceThatItIsRefused) {
  CpuLatency latency("/nowhere/cpu_dma_latency");
  EXPECT_TRUE(latency.hold().starts_with("/nowhere/cpu_dma_latency: No such file or directory; "));
  EXPECT_FALSE(latency.is_held());
  EXPECT_EQ(latency.hold(), "");
}

TEST(CpuLatency, ANodeThatTakesNothingIsNotHeld) {
  CpuLatency latency("/dev/full");
  EXPECT_TRUE(latency.hold().starts_with("/dev/full: No space left on device; "));
  EXPECT_FALSE(latency.is_held());
}

}  // namespace
}  // namespace haptic::rt
