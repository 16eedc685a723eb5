#include "drivers/threaded_device.h"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/device_error.h"
#include "tests/support/device_life.h"

namespace haptic::drivers {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using test::eventually;
using test::reaches;

/// What a routine was asked for, and how it shall fail.
struct Trace {
  std::atomic<int> looked{0};
  std::atomic<int> opened{0};
  std::atomic<int> closed{0};
  std::atomic<int> released{0};
  std::atomic<int> identified{0};
  std::atomic<int> dropped{0};
  std::atomic<bool> zeroed{false};
  std::atomic<double> felt{0.0};
  std::atomic<int> lose{0};  // so many times
  std::atomic<bool> absent{false};
  std::atomic<bool> refuse{false};
  std::atomic<bool> opens_for_ever{false};
  bool cannot_prepare = false;
  int plugs = -1;  // an eventfd of plug notices

  std::mutex mutex;
  std::vector<steady_clock::time_point> openings;
};

class FakeMonitor final : public PlugMonitor {
 public:
  explicit FakeMonitor(int plugs) : plugs_(plugs) {}
  std::vector<int> descriptors() const override { return {plugs_}; }
  bool take() override {
    eventfd_t count = 0;
    return ::eventfd_read(plugs_, &count) == 0;
  }

 private:
  int plugs_;
};

/// Gives samples that count up and notes the force that it is told.
class CountingRoutine final : public DeviceRoutine {
 public:
  explicit CountingRoutine(Trace& trace) : trace_(trace) {}
  void prepare() override {
    if (trace_.cannot_prepare) throw DeviceError("its socket cannot be made");
  }
  void open() override {
    ++trace_.looked;
    if (trace_.absent) throw DeviceAbsent("not connected");
    if (trace_.refuse) throw DeviceError("no permission");
    while (trace_.opens_for_ever) go_on();
    const std::lock_guard lock(trace_.mutex);
    trace_.openings.push_back(steady_clock::now());
    life().tell_serial("A7");
    ++trace_.opened;
  }
  void run(DeviceLink& link, const StopFlag& stop) override {
    for (Nanoseconds n = 1; !stop.is_raised(); ++n) {
      if (trace_.lose > 0) {
        --trace_.lose;
        throw DeviceError("unplugged");
      }
      link.publish({.time = n});
      trace_.felt = link.live_force(0).force.x;
      if (life().take(DeviceAction::kIdentify)) ++trace_.identified;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    trace_.zeroed = true;
  }
  void close() noexcept override { ++trace_.closed; }
  void release() noexcept override { ++trace_.released; }
  bool knows(DeviceAction action) const noexcept override { return action == DeviceAction::kIdentify; }
  std::unique_ptr<PlugMonitor> make_monitor() override {
    return trace_.plugs < 0 ? nullptr : std::make_unique<FakeMonitor>(trace_.plugs);
  }

 private:
  Trace& trace_;
};

class ThreadedDeviceTest : public testing::Test {
 protected:
  Trace trace;
  ThreadedDevice device{
      {.name = "left", .driver = "counting", .max_force = 4.0}, {}, std::make_unique<CountingRoutine>(trace)};
  DeviceSample sample;
};

TEST_F(ThreadedDeviceTest, RunsItsRoutineFromStartToStop) {
  EXPECT_FALSE(device.read(0, sample));
  device.start();
  EXPECT_TRUE(eventually([&] { return device.read(0, sample); }));
  ASSERT_TRUE(reaches(device, DevicePhase::kReady));
  EXPECT_EQ(device.words().serial, "A7");
  EXPECT_EQ(device.words().reason, "");
  device.write(0, {.expires = 1, .force = {1.5, 0.0, 0.0}});
  EXPECT_TRUE(eventually([&] { return trace.felt == 1.5; }));
  device.stop();
  EXPECT_TRUE(trace.zeroed) << "the routine has ended before stop() returns";
  EXPECT_EQ(trace.closed, 1);
  EXPECT_EQ(trace.released, 1);
  EXPECT_FALSE(device.read(0, sample));
  EXPECT_EQ(device.state().phase, DevicePhase::kAbsent);
  EXPECT_EQ(device.state().losses, 0U) << "being stopped is no loss";
}

TEST_F(ThreadedDeviceTest, OneThatIsAbsentAtTheStartIsThereWhenItComes) {
  trace.absent = true;
  device.start();
  ASSERT_TRUE(eventually([&] { return device.words().reason == "not connected"; }));
  EXPECT_EQ(device.state().phase, DevicePhase::kAbsent);
  trace.absent = false;
  EXPECT_TRUE(reaches(device, DevicePhase::kReady));
  EXPECT_TRUE(device.read(0, sample));
}

TEST_F(ThreadedDeviceTest, OneThatIsThereButCannotBeOpenedTellsWhyUntilItCan) {
  trace.refuse = true;
  device.start();
  ASSERT_TRUE(reaches(device, DevicePhase::kFound));
  EXPECT_TRUE(eventually([&] { return device.words().reason == "no permission"; }));
  EXPECT_EQ(device.words().serial, "");
  trace.refuse = false;
  EXPECT_TRUE(reaches(device, DevicePhase::kReady));
}

TEST_F(ThreadedDeviceTest, OneThatIsLostHasNoSampleIsCountedAndIsOpenedAgain) {
  device.start();
  ASSERT_TRUE(eventually([&] { return device.read(0, sample); }));
  trace.absent = true;
  trace.lose = 1;
  EXPECT_TRUE(eventually([&] { return !device.read(0, sample); }));
  EXPECT_TRUE(eventually([&] { return device.state().losses == 1; }));
  EXPECT_TRUE(reaches(device, DevicePhase::kAbsent));
  EXPECT_EQ(trace.closed, 1);
  EXPECT_EQ(device.words().serial, "");
  trace.absent = false;
  EXPECT_TRUE(eventually([&] { return device.read(0, sample); }));
  EXPECT_EQ(device.state().losses, 1U);
  device.stop();
  EXPECT_EQ(trace.closed, 2);
}

TEST_F(ThreadedDeviceTest, OneThatConnectsAndDropsIsLeftAloneForLongerEachTimeAndThatIsTold) {
  trace.lose = 5;
  device.start();
  ASSERT_TRUE(
      eventually([&] { return device.words().reason.find("4 times in a row") != std::string::npos; }));
  const std::string reason = device.words().reason;
  EXPECT_NE(reason.find("unplugged"), std::string::npos) << reason;
  EXPECT_NE(reason.find("opened again in 0.8 s"), std::string::npos) << reason;
  ASSERT_TRUE(eventually([&] { return trace.opened >= 5; }));
  const std::lock_guard lock(trace.mutex);
  for (int i = 1; i < 5; ++i) {
    const auto apart =
        trace.openings[static_cast<std::size_t>(i)] - trace.openings[static_cast<std::size_t>(i - 1)];
    EXPECT_GE(apart, milliseconds(100 << (i - 1))) << i;
  }
}

TEST_F(ThreadedDeviceTest, APlugNoticeIsWorthALookAtOnce) {
  trace.plugs = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  trace.absent = true;
  device.start();
  const auto start = steady_clock::now();
  for (int look = 1; look <= 20; ++look) {
    ASSERT_TRUE(eventually([&] { return trace.looked >= look; }));
    // it may have come before the thread waits, which then has taken it for old
    ASSERT_TRUE(eventually([&] {
      (void)::eventfd_write(trace.plugs, 1);
      return trace.looked > look;
    }));
  }
  EXPECT_LT(steady_clock::now() - start, std::chrono::seconds(30)) << "by waiting alone: 76 s";
  device.stop();
  ::close(trace.plugs);
}

TEST_F(ThreadedDeviceTest, ReopeningClosesAndOpensItAndIsNoLoss) {
  EXPECT_TRUE(device.knows(DeviceAction::kReopen));
  device.start();
  ASSERT_TRUE(reaches(device, DevicePhase::kReady));
  device.request(DeviceAction::kReopen);
  EXPECT_TRUE(eventually([&] { return trace.opened == 2; }));
  EXPECT_TRUE(reaches(device, DevicePhase::kReady));
  EXPECT_EQ(trace.closed, 1);
  EXPECT_EQ(device.state().losses, 0U);
}

TEST_F(ThreadedDeviceTest, ReopeningOneThatIsLeftAloneDoesNotWait) {
  trace.lose = 100;
  device.start();
  const auto start = steady_clock::now();
  for (int opening = 1; opening <= 12; ++opening) {
    ASSERT_TRUE(eventually([&] {
      device.request(DeviceAction::kReopen);
      return trace.opened >= opening;
    }));
  }
  EXPECT_LT(steady_clock::now() - start, std::chrono::seconds(60)) << "left alone it would be 160 s";
}

TEST_F(ThreadedDeviceTest, ARequestReachesTheRoutineOnItsThread) {
  EXPECT_TRUE(device.knows(DeviceAction::kIdentify));
  EXPECT_FALSE(device.knows(DeviceAction::kHome));
  device.start();
  ASSERT_TRUE(reaches(device, DevicePhase::kReady));
  device.request(DeviceAction::kIdentify);
  EXPECT_TRUE(eventually([&] { return trace.identified == 1; }));
}

TEST_F(ThreadedDeviceTest, CanBeStartedAgain) {
  for (int round = 1; round <= 3; ++round) {
    device.start();
    EXPECT_TRUE(eventually([&] { return device.read(0, sample); }));
    device.stop();
    EXPECT_EQ(trace.opened, round);
    EXPECT_EQ(trace.closed, round);
    EXPECT_EQ(trace.released, round);
  }
}

TEST_F(ThreadedDeviceTest, WhatNoPluggingInMendsIsToldAtTheStartWithTheDevicesName) {
  trace.cannot_prepare = true;
  try {
    device.start();
    FAIL() << "no exception";
  } catch (const DeviceError& error) {
    EXPECT_STREQ(error.what(), "device \"left\": its socket cannot be made");
  }
  EXPECT_EQ(trace.looked, 0);
}

TEST_F(ThreadedDeviceTest, StoppingDoesNotWaitForAnOpeningThatTakesLong) {
  trace.opens_for_ever = true;
  device.start();
  ASSERT_TRUE(eventually([&] { return trace.looked == 1; }));
  device.stop();
  EXPECT_EQ(trace.opened, 0);
}

TEST(ThreadedDevice, IsStoppedWhenItIsDestroyed) {
  Trace trace;
  {
    ThreadedDevice device({.name = "left", .driver = "counting", .max_force = 4.0}, {},
                          std::make_unique<CountingRoutine>(trace));
    device.start();
    ASSERT_TRUE(eventually([&] { return trace.opened == 1; }));
  }
  EXPECT_TRUE(trace.zeroed);
  EXPECT_EQ(trace.closed, 1);
}

}  // namespace
}  // namespace haptic::drivers
