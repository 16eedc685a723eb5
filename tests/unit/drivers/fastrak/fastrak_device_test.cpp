// The driver against an emulated tracker at the other end of a pseudo-terminal.

#include "drivers/fastrak/fastrak_device.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <glm/geometric.hpp>
#include <string>
#include <thread>

#include "tests/support/device_life.h"
#include "tests/support/serial_mock.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/drivers/fastrak/fastrak_records.h"

namespace haptic::drivers::fastrak {
namespace {

using std::chrono::milliseconds;
using test::eventually;

/// Answers `S`, and sends records of stations 1 and 2 while it was told to; byte by byte, with garbage
/// between.
class EmulatedTracker {
 public:
  explicit EmulatedTracker(test::SerialMock& port) : port_(port), thread_([this] { serve(); }) {}
  ~EmulatedTracker() {
    ending = true;
    thread_.join();
  }

  std::atomic<bool> deaf{false};
  std::atomic<bool> sends{false};
  std::atomic<bool> fails{false};  // its records tell an error
  std::atomic<int> starts{0};
  std::atomic<bool> ending{false};

 private:
  void serve() {
    for (int round = 0; !ending; ++round) {
      for (const std::uint8_t byte : port_.receive()) take(static_cast<char>(byte));
      if (!sends || deaf) continue;
      std::vector<std::uint8_t> bytes = record_of(1, {10.0F, 0.0F, 20.0F}, {1, 0, 0, 0}, fails ? 'a' : ' ');
      const std::vector<std::uint8_t> other = record_of(2, {99.0F, 99.0F, 99.0F});
      bytes.insert(bytes.end(), other.begin(), other.end());
      if (round % 3 == 0) bytes.insert(bytes.end(), {'0', '1', 0xFF});
      for (const std::uint8_t byte : bytes) port_.send({&byte, 1});
    }
  }

  void take(char c) {
    if (deaf) return;
    // single letters are commands; those with parameters end with CR and are passed over
    const bool is_alone = command_.empty();
    command_ += c;
    if (is_alone && (c == 'c' || c == 'S' || c == 'C' || c == 'f' || c == 'u')) obey(c);
    if (c == '\r' || (is_alone && std::string("cSCfu").find(c) != std::string::npos)) command_.clear();
  }

  void obey(char c) {
    if (c == 'c') sends = false;
    if (c == 'C') {
      sends = true;
      ++starts;
    }
    if (c != 'S') return;
    std::string status = "21S" + std::string(50, '0') + "\r\n";
    port_.send({reinterpret_cast<const std::uint8_t*>(status.data()), status.size()});
  }

  test::SerialMock& port_;
  std::string command_;
  std::thread thread_;
};

FastrakSettings settings(const std::string& port) {
  return {.name = "head",
          .port = port,
          .settle = milliseconds(20),
          .command = milliseconds(2),
          .silence = milliseconds(200)};
}

std::string error_of(Device& device) {
  device.start();
  return test::why_not_open(device);
}

TEST(FastrakDevice, TellsWhereItsStationIsAndNotAnother) {
  test::SerialMock port;
  EmulatedTracker tracker(port);
  const std::unique_ptr<Device> device = make_fastrak(settings(port.path()));
  device->start();
  DeviceSample sample;
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  EXPECT_NEAR(glm::distance(sample.position, glm::dvec3(0.1, 0.0, 0.2)), 0.0, 1e-8);
  device->stop();
  EXPECT_TRUE(eventually([&] { return !tracker.sends; })) << "it is told to be silent";
}

TEST(FastrakDevice, StartsATrackerAgainThatFellSilent) {
  test::SerialMock port;
  EmulatedTracker tracker(port);
  const std::unique_ptr<Device> device = make_fastrak(settings(port.path()));
  device->start();
  DeviceSample sample;
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  tracker.sends = false;
  EXPECT_TRUE(eventually([&] { return tracker.starts >= 2; }));
  EXPECT_EQ(device->state().losses, 1U);
  EXPECT_TRUE(eventually([&] { return device->read(0, sample); }));
}

TEST(FastrakDevice, ARecordWithAnErrorIsNoSample) {
  test::SerialMock port;
  EmulatedTracker tracker(port);
  tracker.fails = true;
  const std::unique_ptr<Device> device = make_fastrak(settings(port.path()));
  device->start();
  DeviceSample sample;
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_FALSE(device->read(0, sample));
  tracker.fails = false;
  EXPECT_TRUE(eventually([&] { return device->read(0, sample); }));
}

TEST(FastrakDevice, OneThatDoesNotAnswerIsToldWithItsPortAndRate) {
  test::SerialMock port;
  EmulatedTracker tracker(port);
  tracker.deaf = true;
  const std::unique_ptr<Device> device = make_fastrak(settings(port.path()));
  EXPECT_EQ(error_of(*device), port.path() + ": nothing answers; is its rate 115200 baud?");
  const std::unique_ptr<Device> nowhere = make_fastrak(settings("/dev/does-not-exist"));
  EXPECT_EQ(error_of(*nowhere), "/dev/does-not-exist: there is no such port; is the device plugged in?");
  EXPECT_EQ(nowhere->state().phase, DevicePhase::kAbsent);
}

TEST(FastrakDevice, UnpluggingItEndsItsSamplesAndStopStillReturns) {
  test::SerialMock port;
  std::unique_ptr<Device> device;
  {
    EmulatedTracker tracker(port);
    device = make_fastrak(settings(port.path()));
    device->start();
    DeviceSample sample;
    ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  }
  port.unplug();
  DeviceSample sample;
  EXPECT_TRUE(eventually([&] { return !device->read(0, sample); }));
  device->stop();
}

// as udev does, a name leads to whichever port it got
TEST(FastrakDevice, ComesWhenItsPortIsPluggedInAndAgainEachTime) {
  const test::TemporaryFolder folder;
  const std::string name = folder.file("tty");
  const std::unique_ptr<Device> device = make_fastrak(settings(name));
  EXPECT_NE(error_of(*device).find("there is no such port"), std::string::npos);
  DeviceSample sample;
  for (std::uint32_t round = 1; round <= 2; ++round) {
    test::SerialMock port;
    {
      EmulatedTracker tracker(port);
      ASSERT_EQ(::symlink(port.path().c_str(), name.c_str()), 0);
      ASSERT_TRUE(test::reaches(*device, DevicePhase::kReady));
      EXPECT_TRUE(device->read(0, sample));
    }
    ASSERT_EQ(::unlink(name.c_str()), 0);
    port.unplug();
    ASSERT_TRUE(eventually([&] { return device->state().losses == round; }));
    ASSERT_TRUE(test::reaches(*device, DevicePhase::kAbsent));
  }
}

}  // namespace
}  // namespace haptic::drivers::fastrak
