// The driver against an emulated tracker at the other end of a pseudo-terminal.

#include "drivers/fastrak/fastrak_device.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/device_life.h"
#include "tests/support/serial_mock.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/drivers/fastrak/fastrak_records.h"

namespace haptic::drivers::fastrak {
namespace {

using std::chrono::milliseconds;
using test::eventually;

/// Answers `S`, and sends records of the stations that are on while it was told to; byte by byte, with
/// garbage between. Station n is at (0.1 n, 0, 0.2).
class EmulatedTracker {
 public:
  /// `heard` of a command it has already.
  explicit EmulatedTracker(test::SerialMock& port, std::string heard = "")
      : port_(port), command_(std::move(heard)), thread_([this] { serve(); }) {}
  ~EmulatedTracker() {
    ending = true;
    thread_.join();
  }

  std::atomic<bool> deaf{false};
  std::atomic<bool> sends{false};
  std::atomic<bool> fails{false};  // its records tell an error
  std::atomic<int> starts{0};
  std::atomic<bool> ending{false};
  std::array<std::atomic<bool>, 5> on{false, true, true, true, true};  // by its switches, until it is told

 private:
  void serve() {
    for (int round = 0; !ending; ++round) {
      for (const std::uint8_t byte : port_.receive()) take(static_cast<char>(byte));
      if (!sends || deaf) continue;
      std::vector<std::uint8_t> bytes;
      for (int station = 1; station <= 4; ++station) {
        if (!on[static_cast<std::size_t>(station)]) continue;
        const std::vector<std::uint8_t> record = record_of(
            station, {10.0F * static_cast<float>(station), 0.0F, 20.0F}, {1, 0, 0, 0}, fails ? 'a' : ' ');
        bytes.insert(bytes.end(), record.begin(), record.end());
      }
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
    if (c == '\r' && command_[0] == 'l') {
      on[static_cast<std::size_t>(command_[1] - '0')] = command_[3] == '1';
    }
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

FastrakSettings settings(const std::string& port, int station = 1) {
  return {.name = "head",
          .line = {.port = port,
                   .settle = milliseconds(20),
                   .command = milliseconds(2),
                   .silence = milliseconds(200)},
          .station = {.number = station}};
}

glm::dvec3 place_of(int station) { return {0.1 * station, 0.0, 0.2}; }

bool is_at(Device& device, const glm::dvec3& place) {
  DeviceSample sample;
  return device.read(0, sample) && glm::distance(sample.position, place) < 1e-7;
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
  EXPECT_NEAR(glm::distance(sample.position, place_of(1)), 0.0, 1e-8);
  EXPECT_FALSE(tracker.on[2]) << "one that nobody listens to takes no share of the records";
  device->stop();
  EXPECT_TRUE(eventually([&] { return !tracker.sends; })) << "it is told to be silent";
}

TEST(FastrakDevice, IsNotKeptOutByHalfACommandThatTheTrackerHeardBefore) {
  test::SerialMock port;
  EmulatedTracker tracker(port, "01 ^@^@HA");  // its own record, echoed before the port was set
  tracker.sends = true;
  const std::unique_ptr<Device> device = make_fastrak(settings(port.path()));
  device->start();
  EXPECT_TRUE(eventually([&] { return is_at(*device, place_of(1)); }));
}

TEST(FastrakDevice, StationsOfOneTrackerAreDevicesThatShareItsPort) {
  test::SerialMock port;
  EmulatedTracker tracker(port);
  std::vector<std::unique_ptr<Device>> devices;
  for (int station = 1; station <= 4; ++station) {
    devices.push_back(make_fastrak(settings(port.path(), station)));
    devices.back()->start();
  }
  for (int station = 1; station <= 4; ++station) {
    Device& device = *devices[static_cast<std::size_t>(station - 1)];
    EXPECT_TRUE(eventually([&] { return is_at(device, place_of(station)); })) << station;
  }
  devices[0]->stop();
  // the others go on
  const auto starts = tracker.starts.load();
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_TRUE(is_at(*devices[3], place_of(4)));
  EXPECT_EQ(devices[3]->state().losses, 0U);
  EXPECT_EQ(tracker.starts, starts);
  for (const auto& device : devices) device->stop();
  EXPECT_TRUE(eventually([&] { return !tracker.sends; })) << "the last one tells it to be silent";
}

TEST(FastrakDevice, ATrackerThatFellSilentIsStartedOnceHoweverManyStationsItHas) {
  test::SerialMock port;
  EmulatedTracker tracker(port);
  std::vector<std::unique_ptr<Device>> devices;
  for (int station = 1; station <= 4; ++station) {
    FastrakSettings patient = settings(port.path(), station);
    patient.line.silence = milliseconds(1000);
    devices.push_back(make_fastrak(patient));
    devices.back()->start();
  }
  for (const auto& device : devices) ASSERT_TRUE(test::reaches(*device, DevicePhase::kReady));
  const int starts = tracker.starts;
  tracker.sends = false;
  for (const auto& device : devices) {
    ASSERT_TRUE(eventually([&] { return device->state().losses == 1; }));
    ASSERT_TRUE(test::reaches(*device, DevicePhase::kReady));
  }
  EXPECT_EQ(tracker.starts, starts + 1);
}

// asked who it is by ^V, told to send by C, both with CR
TEST(FastrakDevice, ServesALibertyByItsOwnProtocol) {
  test::SerialMock port;
  std::atomic<bool> sends{false};
  const std::jthread tracker([&](const std::stop_token& stop) {
    std::string heard;
    while (!stop.stop_requested()) {
      for (const std::uint8_t byte : port.receive()) {
        heard += static_cast<char>(byte);
        if (byte != '\r') continue;
        const std::string version = " 0V Polhemus Liberty\r\n";
        if (heard == "\x16\r") {
          port.send({reinterpret_cast<const std::uint8_t*>(version.data()), version.size()});
        }
        if (heard == "C\r" || heard == "P\r") sends = heard[0] == 'C';
        heard.clear();
      }
      if (sends) port.send(liberty_record_of('L', 'Y', 9, {10.0F, 0.0F, 20.0F}));
    }
  });
  FastrakSettings wanted = settings(port.path(), 9);
  wanted.line.model = Model::kLiberty;
  const std::unique_ptr<Device> device = make_fastrak(wanted);
  device->start();
  EXPECT_TRUE(eventually([&] { return is_at(*device, place_of(1)); }));
  device->stop();
  EXPECT_TRUE(eventually([&] { return !sends; }));
}

TEST(FastrakDevice, AllStationsAreLostWithTheirPortAndComeBackWithIt) {
  const test::TemporaryFolder folder;
  const std::string name = folder.file("tty");
  std::vector<std::unique_ptr<Device>> devices;
  for (int station = 1; station <= 2; ++station) {
    devices.push_back(make_fastrak(settings(name, station)));
    devices.back()->start();
  }
  for (std::uint32_t round = 1; round <= 2; ++round) {
    test::SerialMock port;
    {
      EmulatedTracker tracker(port);
      ASSERT_EQ(::symlink(port.path().c_str(), name.c_str()), 0);
      for (int station = 1; station <= 2; ++station) {
        Device& device = *devices[static_cast<std::size_t>(station - 1)];
        ASSERT_TRUE(eventually([&] { return is_at(device, place_of(station)); })) << station;
      }
    }
    ASSERT_EQ(::unlink(name.c_str()), 0);
    port.unplug();
    for (const auto& device : devices) {
      ASSERT_TRUE(eventually([&] { return device->state().losses >= round; }));
      ASSERT_TRUE(test::reaches(*device, DevicePhase::kAbsent));
    }
  }
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
