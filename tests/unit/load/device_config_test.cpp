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

TEST(DeviceConfig, FillsInTheDefaultsOfTheOthers) {
  const TemporaryFolder folder;
  const v1::Device mouse = device_of(folder, "spacemouse { inverted: \"y\" inverted: \"rz\" }");
  EXPECT_EQ(mouse.spacemouse().speed(), 0.1);
  EXPECT_EQ(mouse.spacemouse().turn_rate(), 1.0);
  EXPECT_EQ(mouse.spacemouse().reach(), 0.2);
  EXPECT_EQ(device_of(folder, "hydra { wand: 1 }").hydra().wand(), 1U);
  const v1::Device tracker = device_of(folder, "fastrak { port: \"/dev/ttyS0\" }");
  EXPECT_EQ(tracker.fastrak().baud(), 115200U);
  EXPECT_EQ(tracker.fastrak().station(), 1U);
  EXPECT_EQ(tracker.fastrak().hemisphere().x(), 1.0);
  const v1::Device arm = device_of(folder, "polhem { model: WOODENHAPTICS_2019 }");
  EXPECT_EQ(arm.polhem().usb().vendor(), 0x16c0U);
  EXPECT_EQ(arm.polhem().usb().product(), 0x0486U);
  EXPECT_EQ(arm.polhem().rest_counts(2), 6000);
  EXPECT_EQ(arm.polhem().max_current(), 2.0);
  EXPECT_EQ(
      device_of(folder, "polhem { model: VINTAGE rest_counts: [1, 2, 3] udp {} }").polhem().udp().port(),
      47111U);
  const v1::Device planar = device_of(folder, "haply { port: \"/dev/ttyACM0\" }");
  EXPECT_EQ(planar.haply().model(), v1::Device::Haply::HARDWARE_3);
  EXPECT_EQ(planar.haply().max_force(), 0.0);
}

TEST(DeviceConfig, TellsTheFieldThatIsWrong) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {"spacemouse { inverted: \"x\" inverted: \"roll\" }", "spacemouse.inverted[1]"},
      {"spacemouse { speed: 3 }", "spacemouse.speed"},
      {"spacemouse { turn_rate: -1 }", "spacemouse.turn_rate"},
      {"spacemouse { reach: 101 }", "spacemouse.reach"},
      {"hydra { wand: 2 }", "hydra.wand"},
      {"fastrak {}", "fastrak.port"},
      {"fastrak { port: \"p\" baud: 9601 }", "fastrak.baud"},
      {"fastrak { port: \"p\" station: 5 }", "fastrak.station"},
      {"fastrak { port: \"p\" hemisphere {} }", "fastrak.hemisphere"},
      {"polhem {}", "polhem.model"},
      {"polhem { model: VINTAGE }", "polhem.rest_counts"},
      {"polhem { model: VINTAGE rest_counts: [1, 2] }", "polhem.rest_counts"},
      {"polhem { model: VINTAGE rest_counts: [1, 2, 40000] }", "polhem.rest_counts[2]"},
      {"polhem { model: WOODENHAPTICS_2019 max_current: 7 }", "polhem.max_current"},
      {"polhem { model: WOODENHAPTICS_2019 max_force: 21 }", "polhem.max_force"},
      {"polhem { model: WOODENHAPTICS_2019 usb { vendor: 65536 } }", "polhem.usb.vendor"},
      {"polhem { model: WOODENHAPTICS_2019 usb { product: 65536 } }", "polhem.usb.product"},
      {"polhem { model: WOODENHAPTICS_2019 udp { port: 65536 } }", "polhem.udp.port"},
      {"haply {}", "haply.port"},
      {"haply { port: \"p\" max_force: 6 }", "haply.max_force"},
  };
  for (const auto& [text, field] : cases) {
    EXPECT_EQ(error_in(folder, text).field(), std::string("device[0].") + field) << text;
  }
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
  for (const char* name :
       {"simulated", "playback", "falcon", "spacemouse", "hydra", "fastrak", "polhem", "haply"}) {
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
