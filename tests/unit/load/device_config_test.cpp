#include "load/device_config.h"

#include "load/check.h"
#include "load/config_file.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

v1::Device device_of(const TemporaryFolder& folder, const std::string& text) {
  return load_config(folder.write("c.txtpb", "device { name: \"d\" " + text + " }")).message.device(0);
}

LoadError error_in(const TemporaryFolder& folder, const std::string& text) {
  return error_of([&] { device_of(folder, text); });
}

TEST(DeviceConfig, FillsInTheDefaultsOfAFalcon) {
  const TemporaryFolder folder;
  const v1::Device device = device_of(folder, "falcon {}");
  EXPECT_EQ(device.falcon().gain(), 10000.0);
  EXPECT_EQ(device.falcon().max_force(), 4.0);
  EXPECT_EQ(driver_name(device), "falcon");
}

TEST(DeviceConfig, ReadsFirmwareBesideTheConfig) {
  const TemporaryFolder folder;
  folder.write("fw.bin", std::string("\x00\xff"
                                     "abc",
                                     5));
  const LoadedConfig config =
      load_config(folder.write("c.txtpb", "device { name: \"d\" falcon { firmware: \"fw.bin\" } }"));
  EXPECT_EQ(config.firmware.at(0), std::string("\x00\xff"
                                               "abc",
                                               5));
}

// the digest of "abc" is that of FIPS 180-4
TEST(DeviceConfig, DigestsAreThoseOfTheStandard) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(DeviceConfig, TakesOnlyTheFirmwareThatTheDigestIsOf) {
  const TemporaryFolder folder;
  folder.write("fw.bin", "abc");
  device_of(folder,
            "falcon { firmware: \"fw.bin\" firmware_sha256: "
            "\"BA7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad\" }");
  folder.write("fw.bin", "abd");
  const LoadError other = error_in(folder,
                                   "falcon { firmware: \"fw.bin\" firmware_sha256: "
                                   "\"ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad\" }");
  EXPECT_EQ(other.field(), "device[0].falcon.firmware_sha256");
  EXPECT_NE(other.message().find(sha256("abd")), std::string::npos) << "the file's own is told";
  EXPECT_EQ(error_in(folder, "falcon { firmware: \"fw.bin\" firmware_sha256: \"ba78\" }").message(),
            "is no SHA-256: expected 64 hexadecimal digits");
  EXPECT_EQ(error_in(folder, "falcon { firmware_sha256: \"ba78\" }").field(),
            "device[0].falcon.firmware_sha256");
}

TEST(DeviceConfig, FirmwareThatCannotBeReadIsAnErrorOfItsField) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_in(folder, "falcon { firmware: \"none.bin\" }").field(), "device[0].falcon.firmware");
  EXPECT_EQ(error_in(folder, "falcon { firmware: \".\" }").field(), "device[0].falcon.firmware");
  folder.write("empty.bin", "");
  EXPECT_NE(error_in(folder, "falcon { firmware: \"empty.bin\" }").message().find("is empty"),
            std::string::npos);
  folder.write("large.bin", std::string(kMaxFirmwareBytes + 1, 'x'));
  EXPECT_NE(error_in(folder, "falcon { firmware: \"large.bin\" }").message().find("is too large"),
            std::string::npos);
}

TEST(DeviceConfig, RefusesNumbersOutOfTheirRanges) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_in(folder, "falcon { gain: 99 }").field(), "device[0].falcon.gain");
  EXPECT_EQ(error_in(folder, "falcon { gain: -1 }").field(), "device[0].falcon.gain");
  EXPECT_EQ(error_in(folder, "falcon { max_force: 10.5 }").field(), "device[0].falcon.max_force");
  EXPECT_EQ(error_in(folder, "falcon { max_force: -1 }").field(), "device[0].falcon.max_force");
}

TEST(DeviceConfig, TheBaseOfHardwareIsNormalised) {
  const TemporaryFolder folder;
  const v1::Device device = device_of(folder, "falcon {} base { orientation { w: 3 z: 4 } }");
  EXPECT_DOUBLE_EQ(device.base().orientation().w(), 0.6);
  EXPECT_DOUBLE_EQ(device.base().orientation().z(), 0.8);
  EXPECT_EQ(error_in(folder, "falcon {} base { position { x: 1e9 } }").field(), "device[0].base.position.x");
}

TEST(DeviceConfig, WhatIsComputedHasNoBase) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_in(folder, "simulated { mass: 1 } base {}").field(), "device[0].base");
}

TEST(DeviceConfig, ADeviceWithoutADriverIsToldWhichThereAre) {
  const TemporaryFolder folder;
  const std::string message = error_in(folder, "").message();
  for (const char* name : {"simulated", "playback", "falcon"}) {
    EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

TEST(DeviceConfig, CheckTellsTheFirmwaresDigest) {
  const TemporaryFolder folder;
  folder.write("fw.bin", "abc");
  const auto config = folder.write("c.txtpb", "device { name: \"d\" falcon { firmware: \"fw.bin\" } }");
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(check({.config = config.string(), .scene = "", .json = false}, out, err), 0) << err.str();
  EXPECT_NE(out.str().find("d: falcon, firmware of 3 bytes, SHA-256 ba7816bf"), std::string::npos)
      << out.str();
}

}  // namespace
}  // namespace haptic::load
