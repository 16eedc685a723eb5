#include "load/safety_config.h"

#include "load/config_file.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

v1::DaemonConfig config_of(const std::string& text) {
  v1::DaemonConfig message;
  const TextSource source = parse_message(text, "/c/hapticd.txtpb", Syntax::kText, message);
  return check_config(message, source, "/c/hapticd.txtpb").message;
}

v1::Device device_of(const std::string& text, const std::string& driver = "simulated { mass: 1 }") {
  return config_of("device { name: \"a\" " + driver + " " + text + " }").device(0);
}

std::string error_in(const std::string& text) {
  return error_of([&] { config_of(text); }).what();
}

/// The part of the error after file, line and column.
std::string device_error(const std::string& text) {
  const std::string error = error_in("device { name: \"a\" simulated { mass: 1 } " + text + " }");
  return error.substr(error.find(" device[0].") + 1);
}

TEST(SafetyConfig, HasTheDefaultsOfTheSchema) {
  const v1::Safety safety = config_of("").safety();
  EXPECT_EQ(safety.max_mean_force(), 0.0);
  EXPECT_EQ(safety.mean_force_time(), 10.0);
  EXPECT_EQ(safety.max_energy(), 1.0);
  EXPECT_EQ(safety.max_arm_force(), 0.5);
  EXPECT_EQ(safety.max_still(), 0.0);
  const v1::Device device = device_of("");
  EXPECT_EQ(device.workspace().scale(), 1.0);
  EXPECT_EQ(device.workspace().force_scale(), 1.0);
  EXPECT_FALSE(device.workspace().has_clutch_button());
  EXPECT_FALSE(device.has_stop_button());
  EXPECT_FALSE(device.limits().has_travel());
}

TEST(SafetyConfig, ADeviceThatTellsItsVelocityKeepsItUnlessAFilterIsAskedFor) {
  using Filter = v1::Device::MotionFilter;
  for (const char* driver :
       {"simulated { mass: 1 }", "virtual {}", "external { path: \"/s\" }", "spacemouse {}"}) {
    EXPECT_EQ(device_of("", driver).workspace().filter().kind(), Filter::DRIVER) << driver;
  }
  for (const char* driver : {"falcon {}", "hydra {}", "haply { port: \"/dev/ttyACM0\" }"}) {
    const Filter filter = device_of("", driver).workspace().filter();
    EXPECT_EQ(filter.kind(), Filter::ADAPTIVE_WINDOW) << driver;
    EXPECT_EQ(filter.window(), 0.02);
    EXPECT_EQ(filter.noise(), 2e-5);
  }
  const Filter asked = device_of("workspace { filter { kind: LOW_PASS } }").workspace().filter();
  EXPECT_EQ(asked.kind(), Filter::LOW_PASS);
  EXPECT_EQ(asked.cutoff(), 40.0);
}

TEST(SafetyConfig, TellsWhatIsOutOfRangeByItsField) {
  EXPECT_EQ(error_in("safety { mean_force_time: 0.05 }"),
            "/c/hapticd.txtpb:1:10: safety.mean_force_time: 0.05 is out of range (permitted: 0.1 to 3600 s)");
  EXPECT_EQ(error_in("safety { max_energy: -1 }"),
            "/c/hapticd.txtpb:1:10: safety.max_energy: -1 is out of range (permitted: more than 0, up to "
            "1e+06 J)");
  EXPECT_EQ(device_error("limits { max_speed: 101 }"),
            "device[0].limits.max_speed: 101 is out of range (permitted: more than 0, up to 100 m/s)");
  EXPECT_EQ(device_error("workspace { scale: -2 }"),
            "device[0].workspace.scale: -2 is out of range (permitted: 0.001 to 1000)");
  EXPECT_EQ(device_error("stop_button: 32"),
            "device[0].stop_button: 32 is out of range (permitted: 0 to 31)");
  EXPECT_EQ(device_error("workspace { filter { kind: ADAPTIVE_WINDOW window: 0.2 } }"),
            "device[0].workspace.filter.window: 0.2 is out of range (permitted: 0.001 to 0.1 s)");
}

TEST(SafetyConfig, ABoxNeedsBothCornersInTheirOrder) {
  EXPECT_EQ(device_error("limits { travel { min {} } }"),
            "device[0].limits.travel.max: is missing: a box has two corners");
  EXPECT_EQ(device_error("limits { travel { min { x: -1 y: -1 z: 2 } max { x: 1 y: 1 z: 1 } } }"),
            "device[0].limits.travel.max.z: 1 is not above that of min, which is 2");
  const v1::Device device =
      device_of("limits { travel { min { x: -1 y: -1 z: -1 } max { x: 1 y: 1 z: 1 } } }");
  EXPECT_EQ(device.limits().travel().max().x(), 1.0);
}

TEST(SafetyConfig, AButtonDoesOneThing) {
  EXPECT_EQ(device_error("stop_button: 3 workspace { clutch_button: 3 }"),
            "device[0].stop_button: is also the clutch");
  EXPECT_EQ(device_of("stop_button: 0 workspace { clutch_button: 31 }").stop_button(), 0U);
}

TEST(SafetyConfig, WhatAFilterDoesNotUseIsAnError) {
  EXPECT_EQ(device_error("workspace { filter { cutoff: 40 } }"),
            "device[0].workspace.filter.cutoff: is of LOW_PASS only");
  EXPECT_EQ(device_error("workspace { filter { kind: LOW_PASS window: 0.02 } }"),
            "device[0].workspace.filter.window: is of ADAPTIVE_WINDOW only");
}

}  // namespace
}  // namespace haptic::load
