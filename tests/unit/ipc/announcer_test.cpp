#include "ipc/announcer.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

using std::chrono::milliseconds;

struct Hall {
  std::vector<v1::DeviceDescription> devices = std::vector<v1::DeviceDescription>(1);
  std::vector<v1::Event> heard;
  Announcer announcer{devices, [this](const v1::Event& event) { heard.push_back(event); }};
  v1::SceneDescription scene;
  SteadyClock::time_point start = SteadyClock::time_point{} + std::chrono::hours(1);

  void tell(const servo::Event& event, milliseconds after = milliseconds(0)) {
    announcer.announce(event, scene, start + after);
  }
};

TEST(Announcer, TellsEverybodyWhatSomebodyDid) {
  Hall hall;
  hall.tell({.kind = servo::EventKind::kDone, .command = servo::CommandKind::kArm, .tick = 9});
  ASSERT_EQ(hall.heard.size(), 1U);
  EXPECT_EQ(hall.heard[0].kind(), v1::Event::ARMED);
  EXPECT_EQ(hall.heard[0].tick(), 9U);
}

TEST(Announcer, SaysNothingOfWhatWasSoAlready) {
  Hall hall;
  hall.tell({.kind = servo::EventKind::kNothingToDo, .command = servo::CommandKind::kArm});
  hall.tell({.kind = servo::EventKind::kFaultRefused, .command = servo::CommandKind::kArm});
  hall.tell({.kind = servo::EventKind::kDone, .command = servo::CommandKind::kResetStats});
  EXPECT_TRUE(hall.heard.empty());
}

TEST(Announcer, NamesTheDeviceOfAFaultAndItsNumbers) {
  Hall hall;
  hall.devices[0].set_name("left");
  hall.tell(
      {.kind = servo::EventKind::kFaultLatched,
       .fault = {.kind = safety::FaultKind::kOverSpeed, .device = 0, .tick = 4, .value = 2.5, .limit = 2.0}});
  ASSERT_EQ(hall.heard.size(), 1U);
  EXPECT_EQ(hall.heard[0].fault().device(), "left");
  EXPECT_EQ(hall.heard[0].message(), "fault latched: left: over speed, 2.5 m/s where 2 m/s is allowed");
}

TEST(Announcer, TellsTheRevisionOfANewScene) {
  Hall hall;
  hall.scene.set_revision(8);
  hall.tell({.kind = servo::EventKind::kDone, .command = servo::CommandKind::kSwapScene});
  ASSERT_EQ(hall.heard.size(), 1U);
  EXPECT_EQ(hall.heard[0].scene_revision(), 8U);
}

TEST(Announcer, SumsMissedTicksOverASecond) {
  Hall hall;
  hall.tell({.kind = servo::EventKind::kTicksMissed, .count = 2});
  hall.tell({.kind = servo::EventKind::kTicksMissed, .count = 3}, milliseconds(10));
  hall.tell({.kind = servo::EventKind::kTicksMissed, .count = 4}, milliseconds(999));
  ASSERT_EQ(hall.heard.size(), 1U);
  EXPECT_EQ(hall.heard[0].message(), "2 ticks were missed");
  hall.announcer.poll(hall.start + milliseconds(1000));
  ASSERT_EQ(hall.heard.size(), 2U);
  EXPECT_EQ(hall.heard[1].message(), "7 ticks were missed");
  hall.announcer.poll(hall.start + milliseconds(5000));
  EXPECT_EQ(hall.heard.size(), 2U);
}

}  // namespace
}  // namespace haptic::ipc
