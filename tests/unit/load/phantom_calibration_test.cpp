#include "load/phantom_calibration.h"

#include "load/config_file.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

const std::string kJoints =
    "joint { encoder: 4 counts_per_radian: 5000 motor: 1 words_per_newton_metre: 600 }\n"
    "joint { encoder: 2 counts_per_radian: -5000 motor: 2 words_per_newton_metre: 600 }\n"
    "joint { encoder: 3 counts_per_radian: 5000 motor: 0 words_per_newton_metre: -600 }\n";
const std::string kGood =
    "upper_arm: 0.2\nforearm: 0.15\n" + kJoints + "reference: REST_AT_START\nmax_force: 6\n";

v1::PhantomCalibration calibration_of(const TemporaryFolder& folder, const std::string& text) {
  return load_phantom_calibration(folder.write("arm.txtpb", text));
}

LoadError error_in(const TemporaryFolder& folder, const std::string& text) {
  return error_of([&] { calibration_of(folder, text); });
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

LoadedConfig config_of(const TemporaryFolder& folder, const std::string& device) {
  return load_config(folder.write("c.txtpb", "device {\n name: \"d\"\n phantom { " + device + " }\n}"));
}

TEST(PhantomCalibration, FillsInItsDefaults) {
  const TemporaryFolder folder;
  const v1::PhantomCalibration calibration = calibration_of(folder, kGood + "button {}");
  EXPECT_EQ(calibration.joint(2).encoder_bits(), 16U);
  EXPECT_EQ(calibration.joint(2).largest_word(), 1024U);
  EXPECT_EQ(calibration.joint(2).min_angle(), -1.5);
  EXPECT_EQ(calibration.joint(2).max_angle(), 1.5);
  EXPECT_EQ(calibration.button().register_(), 6U);
  EXPECT_EQ(calibration.button().bit(), 1U);
}

TEST(PhantomCalibration, ErrorsTellFileLineAndField) {
  const TemporaryFolder folder;
  const LoadError error = error_in(folder, replaced(kGood, "encoder: 2", "encoder: 9"));
  EXPECT_TRUE(error.file().ends_with("arm.txtpb"));
  EXPECT_EQ(error.line(), 4U);
  EXPECT_EQ(error.field(), "joint[1].encoder");
  EXPECT_EQ(error.message(), "9 is out of range (permitted: 0 to 7)");
}

TEST(PhantomCalibration, TwoJointsHaveNeitherEncoderNorMotorInCommon) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_in(folder, replaced(kGood, "encoder: 3", "encoder: 4")).message(),
            "4 is also that of joint[0].encoder");
  EXPECT_EQ(error_in(folder, replaced(kGood, "motor: 0", "motor: 2")).message(),
            "2 is also that of joint[1].motor");
}

TEST(PhantomCalibration, WithoutForceMotorsNeedNotBeKnown) {
  const TemporaryFolder folder;
  std::string text = replaced(kGood, "max_force: 6", "");
  for (int i = 0; i < 2; ++i) text = replaced(text, "words_per_newton_metre: 600", "");
  EXPECT_EQ(calibration_of(folder, text).max_force(), 0.0);
  EXPECT_EQ(error_in(folder, text + "max_force: 1").field(), "joint[0].words_per_newton_metre");
}

// 3 rad of 5000 counts each are 15000, more than the 2048 to either side that 12 bits hold
TEST(PhantomCalibration, ACounterMustNotWrapWithinItsAngles) {
  const TemporaryFolder folder;
  const LoadError error = error_in(folder, replaced(kGood, "encoder: 4", "encoder: 4 encoder_bits: 12"));
  EXPECT_EQ(error.field(), "joint[0].encoder_bits");
  EXPECT_EQ(error.message(), "hold 2048 counts to either side, and the angles take 15000");
}

TEST(PhantomCalibration, HowCountsGetTheirMeaningMustBeSaid) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_in(folder, replaced(kGood, "reference: REST_AT_START", "")).field(), "reference");
  EXPECT_EQ(error_in(folder, replaced(kGood, "REST_AT_START", "REST_AT_BUTTON")).field(), "button");
  EXPECT_EQ(error_in(folder, replaced(kGood, "encoder: 4", "encoder: 4 rest_count: 5")).message(),
            "is only for COUNTS_ARE_KEPT");
}

TEST(PhantomCalibration, IsReadBesideTheConfigAndLimitsItsForce) {
  const TemporaryFolder folder;
  folder.write("arm.txtpb", kGood);
  const LoadedConfig config = config_of(folder, "path: \"/dev/phantom0\" calibration: \"arm.txtpb\"");
  ASSERT_TRUE(config.calibrations.at(0));
  EXPECT_EQ(config.calibrations[0]->joint(0).encoder(), 4U);
  EXPECT_EQ(config.message.device(0).phantom().max_force(), 6.0);
  const std::string beside = "path: \"/dev/phantom0\" calibration: \"arm.txtpb\" max_force: ";
  EXPECT_EQ(config_of(folder, beside + "2").message.device(0).phantom().max_force(), 2.0);
  EXPECT_EQ(error_of([&] { config_of(folder, beside + "7"); }).message(),
            "7 N is more than the calibration allows, 6 N");
}

TEST(PhantomCalibration, WithoutOneThereIsNoForce) {
  const TemporaryFolder folder;
  const LoadedConfig config = config_of(folder, "path: \"/dev/phantom0\"");
  EXPECT_FALSE(config.calibrations.at(0));
  EXPECT_EQ(config.message.device(0).phantom().max_force(), 0.0);
  const LoadError error = error_of([&] { config_of(folder, "path: \"/dev/phantom0\" max_force: 1"); });
  EXPECT_EQ(error.message(), "needs a calibration: there is no force without");
}

TEST(PhantomCalibration, AFileThatIsMissingIsAnErrorOfTheConfigAndAWrongOneOfItself) {
  const TemporaryFolder folder;
  const std::string device = "path: \"/dev/phantom0\" calibration: \"arm.txtpb\"";
  const LoadError missing = error_of([&] { config_of(folder, device); });
  EXPECT_TRUE(missing.file().ends_with("c.txtpb"));
  EXPECT_EQ(missing.field(), "device[0].phantom.calibration");
  folder.write("arm.txtpb", "forearm: 3");
  const LoadError wrong = error_of([&] { config_of(folder, device); });
  EXPECT_TRUE(wrong.file().ends_with("arm.txtpb"));
  EXPECT_EQ(wrong.field(), "upper_arm");
}

}  // namespace
}  // namespace haptic::load
