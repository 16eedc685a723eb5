#include "servo/workspace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_vector.h"

namespace haptic::servo {
namespace {

constexpr double kRounding = 1e-12;
constexpr std::uint32_t kClutch = 1U << 3U;

glm::dquat turn_about(const glm::dvec3& axis, double angle) {
  const double sine = std::sin(angle / 2.0);
  return {std::cos(angle / 2.0), sine * axis.x, sine * axis.y, sine * axis.z};
}

drivers::DeviceSample hand_at(const glm::dvec3& position, std::uint32_t buttons = 0) {
  return {.time = 1, .position = position, .velocity = {0.1, 0.2, 0.3}, .buttons = buttons};
}

/// Whether both turn everything alike.
bool same_turn(const glm::dquat& a, const glm::dquat& b) {
  return std::abs(std::abs(glm::dot(a, b)) - 1.0) < kRounding;
}

TEST(Workspace, ChangesNoBitByDefault) {
  Workspace workspace({});
  const drivers::DeviceSample hand{.time = 7,
                                   .position = {0.1, -0.2, 1e-300},
                                   .orientation = {0.5, 0.5, -0.5, 0.5000000000000001},
                                   .velocity = {1.0 / 3.0, -0.0, 2.0},
                                   .buttons = 0xffffffff};
  const drivers::DeviceSample world = workspace.to_world(hand);
  EXPECT_EQ(world.time, hand.time);
  EXPECT_EQ(world.position, hand.position);
  EXPECT_EQ(world.orientation, hand.orientation);
  EXPECT_EQ(world.velocity, hand.velocity);
  EXPECT_EQ(world.buttons, hand.buttons);
  EXPECT_FALSE(workspace.is_clutched());
}

TEST(Workspace, ScalesAboutTheOriginOfTheBase) {
  Workspace workspace({.world_from_base = {{1.0, 2.0, 3.0}, turn_about({0.0, 0.0, 1.0}, 1.0)}, .scale = 4.0});
  const drivers::DeviceSample world = workspace.to_world(hand_at({1.1, 2.0, 2.8}));
  EXPECT_TRUE(test::near(world.position, {1.4, 2.0, 2.2}, kRounding));
  EXPECT_TRUE(test::near(world.velocity, {0.4, 0.8, 1.2}, kRounding));
  EXPECT_TRUE(test::near(workspace.to_world(hand_at({1.0, 2.0, 3.0})).position, {1.0, 2.0, 3.0}, kRounding));
}

TEST(Workspace, ScalesForcesOnTheHandApart) {
  const Workspace workspace({.scale = 4.0, .force_scale = 0.5});
  const engine::Wrench hand = workspace.to_hand({{2.0, 0.0, -4.0}, {0.2, 0.0, 0.0}});
  EXPECT_EQ(hand.force, glm::dvec3(1.0, 0.0, -2.0));
  EXPECT_EQ(hand.torque, glm::dvec3(0.1, 0.0, 0.0));
}

TEST(Workspace, TellsThePlaceInTheDevicesOwnFrame) {
  // its x is the world's y
  const Workspace workspace(
      {.world_from_base = {{1.0, 0.0, 0.0}, turn_about({0.0, 0.0, 1.0}, M_PI / 2.0)}, .scale = 10.0});
  EXPECT_TRUE(test::near(workspace.to_base({1.0, 0.3, 0.0}), {0.3, 0.0, 0.0}, kRounding));
}

TEST(Workspace, StaysWhereItIsWhileTheClutchIsDownAndGoesOnFromThere) {
  Workspace workspace({.scale = 2.0, .clutch_button = 3});
  EXPECT_TRUE(test::near(workspace.to_world(hand_at({0.1, 0.0, 0.0})).position, {0.2, 0.0, 0.0}, kRounding));
  for (const double x : {0.1, 0.05, -0.3}) {
    const drivers::DeviceSample held = workspace.to_world(hand_at({x, 0.0, 0.0}, kClutch));
    EXPECT_TRUE(workspace.is_clutched());
    EXPECT_TRUE(test::near(held.position, {0.2, 0.0, 0.0}, kRounding));
    EXPECT_EQ(held.velocity, glm::dvec3(0.0));
  }
  // released where the hand now is: no jump, and from there by the scale
  EXPECT_TRUE(test::near(workspace.to_world(hand_at({-0.3, 0.0, 0.0})).position, {0.2, 0.0, 0.0}, kRounding));
  EXPECT_TRUE(
      test::near(workspace.to_world(hand_at({-0.29, 0.0, 0.0})).position, {0.22, 0.0, 0.0}, kRounding));
  EXPECT_FALSE(workspace.is_clutched());
}

TEST(Workspace, AClutchUsedTwiceAddsBothShifts) {
  Workspace workspace({.clutch_button = 3});
  double hand = 0.0;
  for (int stroke = 0; stroke < 5; ++stroke) {  // as a mouse is lifted and put back
    workspace.to_world(hand_at({hand += 0.1, 0.0, 0.0}));
    workspace.to_world(hand_at({hand, 0.0, 0.0}, kClutch));
    workspace.to_world(hand_at({hand -= 0.1, 0.0, 0.0}, kClutch));
    workspace.to_world(hand_at({hand, 0.0, 0.0}));
  }
  EXPECT_TRUE(test::near(workspace.to_world(hand_at({hand, 0.0, 0.0})).position, {0.5, 0.0, 0.0}, kRounding));
}

TEST(Workspace, TheTurnIsHeldTooAndGoesOnAboutTheAxesOfTheWorld) {
  Workspace workspace({.clutch_button = 3});
  const glm::dvec3 x{1.0, 0.0, 0.0};
  const glm::dvec3 z{0.0, 0.0, 1.0};
  drivers::DeviceSample hand = hand_at({});
  hand.orientation = turn_about(z, 0.4);
  workspace.to_world(hand);
  hand.buttons = kClutch;
  EXPECT_TRUE(same_turn(workspace.to_world(hand).orientation, turn_about(z, 0.4)));
  hand.orientation = turn_about(x, -0.9) * turn_about(z, 0.1);
  EXPECT_TRUE(same_turn(workspace.to_world(hand).orientation, turn_about(z, 0.4)));
  hand.buttons = 0;
  EXPECT_TRUE(same_turn(workspace.to_world(hand).orientation, turn_about(z, 0.4))) << "no jump";
  hand.orientation = turn_about(x, 0.3) * hand.orientation;
  EXPECT_TRUE(same_turn(workspace.to_world(hand).orientation, turn_about(x, 0.3) * turn_about(z, 0.4)));
}

TEST(Workspace, OtherButtonsAreNoClutch) {
  Workspace workspace({.clutch_button = 3});
  workspace.to_world(hand_at({}, ~kClutch));
  EXPECT_FALSE(workspace.is_clutched());
  Workspace without({});
  without.to_world(hand_at({}, 0xffffffff));
  EXPECT_FALSE(without.is_clutched());
}

}  // namespace
}  // namespace haptic::servo
