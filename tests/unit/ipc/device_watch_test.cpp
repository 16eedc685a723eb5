#include "ipc/device_watch.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

using drivers::DevicePhase;
using std::chrono::milliseconds;

/// One device, "left", whose life the test makes up.
struct Hall {
  drivers::DeviceState state{.phase = DevicePhase::kReady};
  drivers::DeviceWords words;
  std::unique_ptr<servo::Mailbox> mailbox = std::make_unique<servo::Mailbox>(servo::Capacity{4, 4, 4, 4, 4});
  Services services{.mailbox = *mailbox,
                    .version = "1.2",
                    .devices = std::vector<v1::DeviceDescription>(1),
                    .real_time = {},
                    .scene = {},
                    .running = {},
                    .build_scene = {},
                    .edit_scene = {},
                    .keepers = {{.state = [this] { return state; },
                                 .words = [this] { return words; },
                                 .knows = {},
                                 .request = {}}}};
  std::vector<v1::Event> heard;
  DeviceWatch watch{services, [this](const v1::Event& event) { heard.push_back(event); }};
  SteadyClock::time_point now = SteadyClock::time_point{} + std::chrono::hours(1);

  Hall() { services.devices[0].set_name("left"); }

  void pass(milliseconds time) {
    for (milliseconds step(0); step < time; step += milliseconds(5)) {
      now += milliseconds(5);
      watch.poll(now);
    }
  }
};

TEST(DeviceWatch, SaysNothingOfADeviceThatIsReadyFromTheStart) {
  Hall hall;
  hall.pass(milliseconds(1000));
  EXPECT_TRUE(hall.heard.empty());
}

TEST(DeviceWatch, TellsWhereADeviceGetsToAndWhy) {
  Hall hall;
  hall.state.phase = DevicePhase::kAbsent;
  hall.words.reason = "no USB device is connected";
  hall.pass(milliseconds(60));
  ASSERT_EQ(hall.heard.size(), 1U);
  EXPECT_EQ(hall.heard[0].kind(), v1::Event::DEVICE_CHANGED);
  EXPECT_EQ(hall.heard[0].device(), "left");
  EXPECT_EQ(hall.heard[0].phase(), v1::DEVICE_ABSENT);
  EXPECT_EQ(hall.heard[0].message(), "device left: absent; no USB device is connected");

  hall.pass(milliseconds(500));
  EXPECT_EQ(hall.heard.size(), 1U) << "once";
  hall.state.phase = DevicePhase::kReady;
  hall.words.reason = "";
  hall.pass(milliseconds(60));
  ASSERT_EQ(hall.heard.size(), 2U);
  EXPECT_EQ(hall.heard[1].phase(), v1::DEVICE_READY);
  EXPECT_EQ(hall.heard[1].message(), "device left: ready");
}

TEST(DeviceWatch, TellsALossThatWasOverBeforeItLooked) {
  Hall hall;
  hall.state.losses = 1;
  hall.pass(milliseconds(60));
  ASSERT_EQ(hall.heard.size(), 1U);
  EXPECT_EQ(hall.heard[0].message(), "device left: was lost, and is ready");
}

TEST(DeviceWatch, OfADeviceThatFlickersTellsFourTimesASecondAndThenWhereItIsAtLast) {
  Hall hall;
  for (int i = 0; i < 50; ++i) {
    hall.state.phase = i % 2 == 0 ? DevicePhase::kFound : DevicePhase::kReady;
    hall.state.losses += 1;
    hall.pass(milliseconds(20));
  }
  EXPECT_GE(hall.heard.size(), 3U);
  EXPECT_LE(hall.heard.size(), 5U) << "in a second";
  hall.state.phase = DevicePhase::kHoming;
  hall.pass(milliseconds(400));
  EXPECT_EQ(hall.heard.back().phase(), v1::DEVICE_HOMING);
}

}  // namespace
}  // namespace haptic::ipc
