#include "drivers/threaded_device.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "drivers/device_error.h"
#include "tests/support/eventually.h"

namespace haptic::drivers {
namespace {

using test::eventually;

/// What a routine was asked for, and how it shall fail.
struct Trace {
  std::atomic<int> opened{0};
  std::atomic<int> closed{0};
  std::atomic<bool> zeroed{false};
  std::atomic<double> felt{0.0};
  std::atomic<bool> lose{false};
  bool refuse = false;
};

/// Gives samples that count up and notes the force that it is told.
class CountingRoutine final : public DeviceRoutine {
 public:
  explicit CountingRoutine(Trace& trace) : trace_(trace) {}
  void open() override {
    if (trace_.refuse) throw DeviceError("not connected");
    ++trace_.opened;
  }
  void run(DeviceLink& link, const StopFlag& stop) override {
    for (Nanoseconds n = 1; !stop.is_raised(); ++n) {
      if (trace_.lose) throw DeviceError("unplugged");
      link.publish({.time = n});
      trace_.felt = link.live_force(0).force.x;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    trace_.zeroed = true;
  }
  void close() noexcept override { ++trace_.closed; }

 private:
  Trace& trace_;
};

ThreadedDevice device_of(Trace& trace) {
  return {
      {.name = "left", .driver = "counting", .max_force = 4.0}, {}, std::make_unique<CountingRoutine>(trace)};
}

TEST(ThreadedDevice, RunsItsRoutineFromStartToStop) {
  Trace trace;
  ThreadedDevice device = device_of(trace);
  DeviceSample sample;
  EXPECT_FALSE(device.read(0, sample));
  device.start();
  EXPECT_TRUE(eventually([&] { return device.read(0, sample); }));
  device.write(0, {.expires = 1, .force = {1.5, 0.0, 0.0}});
  EXPECT_TRUE(eventually([&] { return trace.felt == 1.5; }));
  device.stop();
  EXPECT_TRUE(trace.zeroed) << "the routine has ended before stop() returns";
  EXPECT_EQ(trace.closed, 1);
  EXPECT_FALSE(device.read(0, sample));
}

TEST(ThreadedDevice, ADeviceThatIsLostHasNoSampleAndCanBeStopped) {
  Trace trace;
  ThreadedDevice device = device_of(trace);
  device.start();
  DeviceSample sample;
  ASSERT_TRUE(eventually([&] { return device.read(0, sample); }));
  trace.lose = true;
  EXPECT_TRUE(eventually([&] { return !device.read(0, sample); }));
  device.stop();
  EXPECT_EQ(trace.closed, 1);
}

TEST(ThreadedDevice, CanBeStartedAgain) {
  Trace trace;
  ThreadedDevice device = device_of(trace);
  DeviceSample sample;
  for (int round = 1; round <= 3; ++round) {
    device.start();
    EXPECT_TRUE(eventually([&] { return device.read(0, sample); }));
    device.stop();
    EXPECT_EQ(trace.opened, round);
    EXPECT_EQ(trace.closed, round);
  }
}

TEST(ThreadedDevice, WhatCannotBeOpenedIsToldWithTheDevicesName) {
  Trace trace;
  trace.refuse = true;
  ThreadedDevice device = device_of(trace);
  try {
    device.start();
    FAIL() << "no exception";
  } catch (const DeviceError& error) {
    EXPECT_STREQ(error.what(), "device \"left\": not connected");
  }
  EXPECT_EQ(trace.closed, 0);
}

TEST(ThreadedDevice, IsStoppedWhenItIsDestroyed) {
  Trace trace;
  {
    ThreadedDevice device = device_of(trace);
    device.start();
  }
  EXPECT_TRUE(trace.zeroed);
  EXPECT_EQ(trace.closed, 1);
}

}  // namespace
}  // namespace haptic::drivers
