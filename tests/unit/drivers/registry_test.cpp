#include "drivers/registry.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <limits>

#include "haptic/v1/calibration.pb.h"

namespace haptic::drivers {
namespace {

TEST(Registry, MakesASimulatedDeviceOfItsConfig) {
  v1::Device config;
  config.set_name("left");
  config.mutable_simulated()->set_mass(0.2);
  config.mutable_simulated()->set_damping(4.0);
  config.mutable_simulated()->mutable_hand()->set_path("left.csv");
  EXPECT_EQ(path_file_of(config), "left.csv");

  const std::unique_ptr<Device> device = make_device(config, {{.position = {0.1, 0.0, 0.0}}});
  EXPECT_EQ(device->info().name, "left");
  EXPECT_EQ(device->info().driver, "simulated");
  device->start();
  DeviceSample sample;
  ASSERT_TRUE(device->read(0, sample));
  EXPECT_EQ(sample.position.x, 0.1);
  // without a hand a force of 1 N against 4 N s/m ends at 0.25 m/s
  for (Nanoseconds now = 0; now < 1'000'000'000; now += 1'000'000) {
    device->write(now, {.expires = now + 2'000'000, .force = {1.0, 0.0, 0.0}});
    ASSERT_TRUE(device->read(now + 1'000'000, sample));
  }
  EXPECT_NEAR(sample.velocity.x, 0.25, 1e-6);
}

TEST(Registry, TheHandHoldsASimulatedDevice) {
  v1::Device config;
  config.mutable_simulated()->set_mass(0.1);
  config.mutable_simulated()->mutable_hand()->set_stiffness(100.0);
  config.mutable_simulated()->mutable_hand()->set_damping(5.0);
  config.mutable_simulated()->mutable_hand()->set_repeat(true);
  const std::unique_ptr<Device> device = make_device(config, {});
  device->start();
  DeviceSample sample;
  // 1 N against 100 N/m
  for (Nanoseconds now = 0; now < 2'000'000'000; now += 1'000'000) {
    ASSERT_TRUE(device->read(now, sample));
    device->write(now, {.expires = now + 2'000'000, .force = {1.0, 0.0, 0.0}});
  }
  EXPECT_NEAR(sample.position.x, 0.01, 1e-6);
}

TEST(Registry, MakesAPlaybackDeviceOfItsConfig) {
  v1::Device config;
  config.set_name("probe");
  config.mutable_playback()->set_path("press.csv");
  config.mutable_playback()->set_repeat(true);
  EXPECT_EQ(path_file_of(config), "press.csv");

  const std::unique_ptr<Device> device =
      make_device(config, {{.time = 0.0}, {.time = 1.0, .position = {1.0, 0.0, 0.0}}});
  EXPECT_EQ(device->info().name, "probe");
  EXPECT_EQ(device->info().driver, "playback");
  device->start();
  DeviceSample sample;
  ASSERT_TRUE(device->read(0, sample));
  ASSERT_TRUE(device->read(1'250'000'000, sample));
  EXPECT_DOUBLE_EQ(sample.position.x, 0.25) << "the path starts again";
}

TEST(Registry, MakesAFalconOfItsConfig) {
  v1::Device config;
  config.set_name("right");
  config.mutable_falcon()->set_max_force(2.5);
  EXPECT_EQ(path_file_of(config), "");
  const std::unique_ptr<Device> device = make_device(config, {}, "firmware");
  EXPECT_EQ(device->info().name, "right");
  EXPECT_EQ(device->info().driver, "falcon");
  EXPECT_EQ(device->info().max_force, 2.5);
}

TEST(Registry, APhantomGivesForceByItsCalibrationOnly) {
  v1::Device config;
  config.set_name("arm");
  config.mutable_phantom()->set_path("/dev/phantom0");
  config.mutable_phantom()->set_max_force(3.0);
  EXPECT_EQ(make_device(config, {})->info().max_force, 0.0);
  v1::PhantomCalibration calibration;
  for (int i = 0; i < 3; ++i) calibration.add_joint();
  const std::unique_ptr<Device> device = make_device(config, {}, {}, &calibration);
  EXPECT_EQ(device->info().driver, "phantom");
  EXPECT_EQ(device->info().max_force, 3.0);
}

TEST(Registry, ADriverTellsWhatItsDeviceBearsAndWhetherItHasMotors) {
  const auto info_of = [](const auto& choose) {
    v1::Device config;
    choose(config);
    return make_device(config, {})->info();
  };
  const DeviceInfo falcon = info_of([](v1::Device& config) { config.mutable_falcon(); });
  EXPECT_EQ(falcon.travel_min, glm::dvec3(-0.08, -0.08, 0.05));
  EXPECT_EQ(falcon.travel_max, glm::dvec3(0.08, 0.08, 0.19));
  EXPECT_TRUE(falcon.exerts_force);
  const DeviceInfo simulated = info_of([](v1::Device& config) { config.mutable_simulated()->set_mass(1.0); });
  EXPECT_EQ(simulated.travel_max, glm::dvec3(DeviceInfo::kNone));
  EXPECT_EQ(simulated.max_mean_force, DeviceInfo::kNone);
  EXPECT_TRUE(simulated.exerts_force);
  EXPECT_FALSE(info_of([](v1::Device& config) { config.mutable_playback(); }).exerts_force);
  EXPECT_FALSE(info_of([](v1::Device& config) { config.mutable_spacemouse(); }).exerts_force);
  EXPECT_FALSE(info_of([](v1::Device& config) { config.mutable_hydra(); }).exerts_force);
  EXPECT_FALSE(info_of([](v1::Device& config) { config.mutable_fastrak()->set_port("/none"); }).exerts_force);
  EXPECT_FALSE(info_of([](v1::Device& config) {
                 config.mutable_polhem()->mutable_udp()->set_port(47111);
               }).exerts_force);
  EXPECT_TRUE(info_of([](v1::Device& config) { config.mutable_polhem(); }).exerts_force);
}

TEST(Registry, EveryDriverOfTheSchemaIsKnown) {
  const google::protobuf::OneofDescriptor* const drivers =
      v1::Device::descriptor()->FindOneofByName("driver");
  for (int i = 0; i < drivers->field_count(); ++i) {
    v1::Device config;
    config.set_name("it");
    config.GetReflection()->MutableMessage(&config, drivers->field(i));
    const std::unique_ptr<Device> device = make_device(config, {});
    EXPECT_EQ(device->info().name, "it");
    EXPECT_EQ(device->info().driver, drivers->field(i)->name());
  }
}

TEST(Registry, OnlyWhatFollowsAPathIsComputed) {
  v1::Device config;
  config.mutable_simulated();
  EXPECT_TRUE(is_computed(config));
  config.mutable_playback();
  EXPECT_TRUE(is_computed(config));
  config.mutable_falcon();
  EXPECT_FALSE(is_computed(config));
}

TEST(Registry, InjectsTheFaultsOfASimulatedDevicesConfig) {
  v1::Device config;
  config.mutable_simulated()->set_mass(0.1);
  auto& late = *config.mutable_simulated()->add_fault();
  late.set_kind(v1::Device::Simulated::InjectedFault::JUMP);
  late.set_at(0.01);
  late.set_duration(0.005);
  late.mutable_offset()->set_z(0.5);
  auto& gone = *config.mutable_simulated()->add_fault();
  gone.set_kind(v1::Device::Simulated::InjectedFault::UNPLUG);
  gone.set_at(0.02);
  const std::unique_ptr<Device> device = make_device(config, {});
  device->start();
  DeviceSample sample;
  const auto z_at = [&](Nanoseconds milliseconds) {
    EXPECT_TRUE(device->read(milliseconds * 1'000'000, sample)) << milliseconds;
    return sample.position.z;
  };
  EXPECT_EQ(z_at(0), 0.0);
  EXPECT_EQ(z_at(9), 0.0);
  EXPECT_EQ(z_at(10), 0.5);
  EXPECT_EQ(z_at(14), 0.5);
  EXPECT_EQ(z_at(15), 0.0);
  EXPECT_FALSE(device->read(20'000'000, sample));
  EXPECT_FALSE(device->read(3'600'000'000'000, sample)) << "without a duration it does not end";
}

TEST(Registry, MakesDevicesThatOthersServe) {
  v1::Device config;
  config.set_name("mouse");
  config.mutable_virtual_();
  EXPECT_FALSE(is_computed(config));
  EXPECT_EQ(path_file_of(config), "");
  const std::unique_ptr<Device> mouse = make_device(config, {});
  EXPECT_EQ(mouse->info().name, "mouse");
  EXPECT_EQ(mouse->info().driver, "virtual");
  EXPECT_EQ(mouse->info().max_force, std::numeric_limits<double>::infinity());

  config.mutable_external()->set_path("s");
  EXPECT_FALSE(is_computed(config));
  EXPECT_EQ(make_device(config, {})->info().max_force, std::numeric_limits<double>::infinity());
  config.mutable_external()->set_max_force(3.5);
  const std::unique_ptr<Device> arm = make_device(config, {});
  EXPECT_EQ(arm->info().driver, "external");
  EXPECT_EQ(arm->info().max_force, 3.5);
}

TEST(Registry, ADeviceWithoutADriverIsAnErrorThatNamesIt) {
  v1::Device config;
  config.set_name("nameless");
  EXPECT_EQ(path_file_of(config), "");
  try {
    make_device(config, {});
    FAIL() << "no exception";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("nameless"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace haptic::drivers
