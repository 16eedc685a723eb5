#include "drivers/device_life.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "drivers/device_link.h"

namespace haptic::drivers {
namespace {

TEST(DeviceLife, BeginsAbsentAndTellsWhatItsDriverTold) {
  DeviceLife life;
  EXPECT_EQ(life.state().phase, DevicePhase::kAbsent);
  life.tell(DevicePhase::kHoming, "move it");
  life.tell_serial("A7");
  EXPECT_EQ(life.state().phase, DevicePhase::kHoming);
  EXPECT_EQ(life.words().reason, "move it");
  EXPECT_EQ(life.words().serial, "A7");
}

TEST(DeviceLife, IsReadyWithTheFirstSampleAndThenNeedsNoReason) {
  DeviceLife life;
  DeviceLink link({}, &life);
  life.tell(DevicePhase::kOpening, "no sample yet");
  link.publish_nothing();
  EXPECT_EQ(life.state().phase, DevicePhase::kOpening);
  link.publish({.time = 1});
  EXPECT_EQ(life.state().phase, DevicePhase::kReady);
  EXPECT_EQ(life.words().reason, "");
}

TEST(DeviceLife, CountsLosses) {
  DeviceLife life;
  life.ready();
  life.lose(DevicePhase::kFound, "unplugged");
  EXPECT_EQ(life.state().losses, 1U);
  EXPECT_EQ(life.state().phase, DevicePhase::kFound);
  EXPECT_EQ(life.words().reason, "unplugged");
  life.tell(DevicePhase::kAbsent, "gone");
  EXPECT_EQ(life.state().losses, 1U) << "telling is no loss";
}

TEST(DeviceLife, ARequestIsTakenOnce) {
  DeviceLife life;
  EXPECT_FALSE(life.take(DeviceAction::kHome));
  life.request(DeviceAction::kHome);
  EXPECT_FALSE(life.take(DeviceAction::kIdentify));
  EXPECT_TRUE(life.take(DeviceAction::kHome));
  EXPECT_FALSE(life.take(DeviceAction::kHome));
  life.request(DeviceAction::kHome);
  life.forget_requests();
  EXPECT_FALSE(life.take(DeviceAction::kHome));
}

TEST(DeviceLife, CanBeReadByTheServoAndTheIoThreadWhileItsDriverTells) {
  DeviceLife life;
  std::atomic<bool> ending{false};
  std::thread servo([&] {
    std::uint32_t before = 0;
    while (!ending) {
      const std::uint32_t losses = life.state().losses;
      EXPECT_GE(losses, before);
      before = losses;
    }
  });
  std::thread io([&] {
    while (!ending) {
      const std::string reason = life.words().reason;
      EXPECT_TRUE(reason.empty() || reason == "a reason that is too long to lie in the string itself");
      life.request(DeviceAction::kIdentify);
    }
  });
  for (int i = 0; i < 2000; ++i) {
    life.ready();
    life.lose(DevicePhase::kFound, "a reason that is too long to lie in the string itself");
    life.take(DeviceAction::kIdentify);
  }
  ending = true;
  servo.join();
  io.join();
  EXPECT_EQ(life.state().losses, 2000U);
}

}  // namespace
}  // namespace haptic::drivers
