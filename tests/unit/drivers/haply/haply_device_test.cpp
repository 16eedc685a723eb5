// The driver against an emulated board at the other end of a pseudo-terminal.

#include "drivers/haply/haply_device.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <thread>

#include "rt/tick_clock.h"
#include "tests/support/device_life.h"
#include "tests/support/serial_mock.h"

namespace haptic::drivers::haply {
namespace {

using test::eventually;
constexpr Nanoseconds kSecond = 1'000'000'000;
constexpr float kJoint1 = 108.0F;  // degrees
constexpr float kJoint2 = 72.0F;

/// Answers each request with the same angles, in two pieces; as often as it is told, with a stray byte
/// before.
class EmulatedBoard {
 public:
  explicit EmulatedBoard(test::SerialMock& port) : port_(port), thread_([this] { serve(); }) {}
  ~EmulatedBoard() {
    ending = true;
    thread_.join();
  }

  std::atomic<bool> deaf{false};
  std::atomic<int> strays{0};
  std::atomic<bool> is_set_up{false};
  std::atomic<float> torque1{0.0F};
  std::atomic<float> torque2{0.0F};
  std::atomic<int> broken{0};
  std::atomic<bool> ending{false};

 private:
  void serve() {
    while (!ending) {
      for (const std::uint8_t byte : port_.receive()) bytes_.push_back(byte);
      while (!bytes_.empty() && take()) {
      }
    }
  }

  bool take() {
    const std::size_t length = bytes_[0] == 0   ? 2
                               : bytes_[0] == 1 ? kSetupBytes
                               : bytes_[0] == 2 ? kRequestBytes
                                                : 0;
    if (length == 0) {
      ++broken;
      bytes_.clear();
      return false;
    }
    if (bytes_.size() < length) return false;
    if (bytes_[0] == 0) is_set_up = false;
    if (bytes_[0] == 1) is_set_up = true;
    if (bytes_[0] == 2) answer();
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(length));
    return true;
  }

  void answer() {
    float torque = 0.0F;
    std::memcpy(&torque, bytes_.data() + 2, 4);
    torque2 = torque;
    std::memcpy(&torque, bytes_.data() + 6, 4);
    torque1 = torque;
    if (deaf || !is_set_up) return;
    std::array<std::uint8_t, 9> reply{5};
    std::memcpy(reply.data() + 1, &kJoint2, 4);
    std::memcpy(reply.data() + 5, &kJoint1, 4);
    const std::uint8_t stray = 0x77;
    if (strays > 0) {
      port_.send({&stray, 1});
      --strays;
    }
    port_.send(std::span(reply).first(4));
    port_.send(std::span(reply).subspan(4));
  }

  test::SerialMock& port_;
  std::vector<std::uint8_t> bytes_;
  std::thread thread_;
};

HaplySettings settings(const test::SerialMock& port, double max_force = 2.0) {
  return {
      .name = "plane", .port = port.path(), .max_force = max_force, .reply = std::chrono::milliseconds(100)};
}

void push(Device& device, const glm::dvec3& force) {
  const Nanoseconds later = rt::monotonic_ns() + kSecond;
  device.write(later, {.expires = later, .force = force});
}

TEST(HaplyDevice, TellsTheHandleAndPushesItWithTheTorquesOfTheForce) {
  test::SerialMock port;
  EmulatedBoard board(port);
  const std::unique_ptr<Device> device = make_haply(settings(port));
  device->start();
  DeviceSample sample;
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  const std::array<double, 2> angles = {kJoint1 * std::numbers::pi / 180.0,
                                        kJoint2 * std::numbers::pi / 180.0};
  EXPECT_NEAR(glm::distance(sample.position, glm::dvec3(*handle_position(kGeometry3, angles), 0.0)), 0.0,
              1e-6);

  const auto torques = arm_torques(kGeometry3, angles, {0.6, -0.8});
  ASSERT_TRUE(torques);
  EXPECT_TRUE(eventually([&] {
    push(*device, {0.6, -0.8, 0.0});
    return std::abs(board.torque1 - (*torques)[0]) < 1e-6 && std::abs(board.torque2 - (*torques)[1]) < 1e-6;
  }));
  device->stop();
  EXPECT_TRUE(eventually([&] { return board.torque1 == 0.0F && board.torque2 == 0.0F; }));
  EXPECT_EQ(board.broken, 0);
}

TEST(HaplyDevice, WithoutALimitOfForceItGivesNone) {
  test::SerialMock port;
  EmulatedBoard board(port);
  const std::unique_ptr<Device> device = make_haply(settings(port, 0.0));
  EXPECT_EQ(device->info().max_force, 0.0);
  device->start();
  DeviceSample sample;
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  for (int i = 0; i < 50; ++i) {
    push(*device, {1.0, 1.0, 0.0});
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_EQ(board.torque1, 0.0F);
  }
}

TEST(HaplyDevice, FindsItsWayBackAfterStrayBytes) {
  test::SerialMock port;
  EmulatedBoard board(port);
  const std::unique_ptr<Device> device = make_haply(settings(port));
  device->start();
  for (int i = 0; i < 5; ++i) {
    board.strays = 1;
    ASSERT_TRUE(eventually([&] { return board.strays == 0; }));
    const Nanoseconds then = rt::monotonic_ns();
    DeviceSample sample;
    ASSERT_TRUE(eventually([&] { return device->read(0, sample) && sample.time > then; }));
    EXPECT_NEAR(sample.position.x, 0.019, 1e-6);
  }
}

TEST(HaplyDevice, SilenceEndsItsSamplesAndTorques) {
  test::SerialMock port;
  EmulatedBoard board(port);
  const std::unique_ptr<Device> device = make_haply(settings(port));
  device->start();
  DeviceSample sample;
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  ASSERT_TRUE(eventually([&] {
    push(*device, {1.0, 0.0, 0.0});
    return board.torque1 != 0.0F;
  }));
  board.deaf = true;
  EXPECT_TRUE(eventually([&] { return !device->read(0, sample); }));
  EXPECT_TRUE(eventually([&] { return board.torque1 == 0.0F; }));
  EXPECT_TRUE(eventually([&] { return device->state().losses == 1; })) << "after a second";
  board.deaf = false;
  EXPECT_TRUE(eventually([&] { return device->read(0, sample); })) << "it is opened again";
}

TEST(HaplyDevice, OneThatDoesNotAnswerIsToldWithItsPort) {
  test::SerialMock port;
  EmulatedBoard board(port);
  board.deaf = true;
  HaplySettings haply = settings(port);
  haply.reply = std::chrono::milliseconds(2);
  const std::unique_ptr<Device> device = make_haply(haply);
  device->start();
  EXPECT_EQ(test::why_not_open(*device), port.path() + ": no Haply board answers");
}

TEST(HaplyDevice, UnpluggingItEndsItsSamplesAndStopStillReturns) {
  test::SerialMock port;
  std::unique_ptr<Device> device;
  DeviceSample sample;
  {
    EmulatedBoard board(port);
    device = make_haply(settings(port));
    device->start();
    ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  }
  port.unplug();
  EXPECT_TRUE(eventually([&] { return !device->read(0, sample); }));
  device->stop();
}

}  // namespace
}  // namespace haptic::drivers::haply
