#include "drivers/hydra/hydra_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/unit/drivers/hydra/hydra_reports.h"

namespace haptic::drivers::hydra {
namespace {

TEST(HydraProtocol, TellsEachWandsPlaceMirroredInX) {
  const auto report = motion_report({.millimetres = {100, -200, 300}}, {.millimetres = {-1, 2, -3}});
  ASSERT_EQ(report.size(), kReportBytes);
  EXPECT_NEAR(glm::distance(decode(report, 0)->position, glm::dvec3(-0.1, -0.2, 0.3)), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(decode(report, 1)->position, glm::dvec3(0.001, 0.002, -0.003)), 0.0, 1e-15);
}

// A place that is turned in its frame and then mirrored is the mirrored place turned by the mirrored
// rotation.
TEST(HydraProtocol, MirrorsRotationsAsItMirrorsPlaces) {
  const glm::dquat turn = glm::normalize(glm::dquat(0.5, 0.3, -0.6, 0.2));
  const auto raw = [](double value) { return static_cast<int>(std::lround(value * 32768)); };
  const auto wand =
      decode(motion_report({.quaternion = {raw(turn.w), raw(turn.x), raw(turn.y), raw(turn.z)}}, {}), 0);
  ASSERT_TRUE(wand);
  const glm::dvec3 mirror(-1.0, 1.0, 1.0);
  const glm::dvec3 place(0.1, 0.2, 0.3);
  EXPECT_NEAR(glm::distance(wand->orientation * (mirror * place), mirror * (turn * place)), 0.0, 1e-4);
  EXPECT_NEAR(glm::length(wand->orientation), 1.0, 1e-15);
}

TEST(HydraProtocol, TellsButtonsWithoutTheBitThatIsAlwaysSet) {
  EXPECT_EQ(decode(motion_report({}, {}), 0)->buttons, 0U);
  EXPECT_EQ(decode(motion_report({.buttons = 0xC1}, {}), 0)->buttons, 0x41U);
  EXPECT_EQ(decode(motion_report({}, {.trigger = 127}), 1)->buttons, 0U);
  EXPECT_EQ(decode(motion_report({}, {.trigger = 128}), 1)->buttons, 0x80U) << "the trigger is one too";
}

TEST(HydraProtocol, WhatIsNoMotionReportIsRefused) {
  auto report = motion_report({}, {});
  EXPECT_FALSE(decode(report, 2));
  report.pop_back();
  EXPECT_FALSE(decode(report, 0));
  EXPECT_FALSE(decode({}, 0));
  EXPECT_FALSE(decode(std::vector<std::uint8_t>(12), 0)) << "the gamepad's";
}

TEST(HydraProtocol, ARotationThatIsNoneIsRefused) {
  EXPECT_FALSE(decode(motion_report({.quaternion = {0, 0, 0, 0}}, {}), 0));
  EXPECT_FALSE(decode(motion_report({.quaternion = {32767, 32767, 0, 0}}, {}), 0));
}

// index 0 is the report's id; the last pair is a sum of all that stands before it, by exclusive or
TEST(HydraProtocol, ModeReportsAreThoseThatWereSeenOnTheWire) {
  const auto motion = mode_report(Mode::kMotion);
  EXPECT_EQ(motion[0], 0);
  EXPECT_EQ(motion[6], 0x01);
  EXPECT_EQ(motion[8], 0x04);
  EXPECT_EQ(motion[9], 0x03);
  EXPECT_EQ(motion[89], 0x06);
  const auto gamepad = mode_report(Mode::kGamepad);
  EXPECT_EQ(gamepad[9], 0x00);
  EXPECT_EQ(gamepad[89], 0x05);
}

}  // namespace
}  // namespace haptic::drivers::hydra
