// The example, as a program of its own, against the device: what it prints is what it felt.

#include <gtest/gtest.h>
#include <poll.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "drivers/external/external_device.h"
#include "rt/tick_clock.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace haptic::drivers::external {
namespace {

struct Close {
  void operator()(std::FILE* file) const { ::pclose(file); }
};

TEST(SpringExample, ServesADeviceAndFeelsItsForce) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("left.sock");
  const auto device = make_external({.name = "left", .path = path});
  device->start();
  const std::string command = test::build_dir() + "/proto/device/spring_example " + path + " 0.6 2>&1";
  const std::unique_ptr<std::FILE, Close> program(::popen(command.c_str(), "r"));
  ASSERT_TRUE(program);

  DeviceSample sample;
  double lowest = 1.0;
  double largest_x = 0.0;
  const Nanoseconds end = rt::monotonic_ns() + 30'000'000'000;
  pollfd printed{::fileno(program.get()), POLLIN, 0};
  while (::poll(&printed, 1, 0) == 0 && rt::monotonic_ns() < end) {
    const Nanoseconds now = rt::monotonic_ns();
    if (device->read(now, sample)) {
      lowest = std::min(lowest, sample.position.y);
      largest_x = std::max(largest_x, sample.position.x);
    }
    device->write(now, {.expires = now + 3'000'000, .force = {3.0, 0.0, 0.0}});
    const timespec pause{0, 500'000};
    ::nanosleep(&pause, nullptr);
  }
  char line[256] = {};
  ASSERT_NE(std::fgets(line, sizeof(line), program.get()), nullptr);
  EXPECT_NE(std::string(line).find("600 samples, "), std::string::npos) << line;
  EXPECT_NE(std::string(line).find("largest force 3.000 N"), std::string::npos) << line;
  // its hand has moved down by 20 mm (1 - cos(0.6 pi)) and lags a little; 3 N push its 300 N/m by 10 mm, and
  // with 0.55 of the critical damping it swings beyond by exp(-pi 0.55 / sqrt(1 - 0.55^2)) = 13 %
  EXPECT_LT(lowest, 0.0);
  EXPECT_GT(largest_x, 0.005);
  EXPECT_LT(largest_x, 0.012);
}

}  // namespace
}  // namespace haptic::drivers::external
