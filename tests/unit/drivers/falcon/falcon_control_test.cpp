#include "drivers/falcon/falcon_control.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

#include "rt/allocation_guard.h"
#include "tests/unit/drivers/falcon/falcon_rig.h"

namespace haptic::drivers::falcon {
namespace {

constexpr glm::dvec3 kPush{0.0, 0.0, 2.0};
constexpr unsigned kGreen = 3;  // with the bit for homing
constexpr unsigned kBlue = 5;
constexpr unsigned kRed = 9;

TEST(FalconControl, TellsWhereTheGripIsOnceItIsHomed) {
  FalconRig rig;
  rig.settle_at({0.01, -0.02, 0.12});
  ASSERT_TRUE(rig.control.sample());
  EXPECT_NEAR(glm::distance(rig.control.sample()->position, glm::dvec3(0.01, -0.02, 0.12)), 0.0, 1e-4);
  EXPECT_EQ(rig.control.sample()->time, rig.now + kMillisecond / 2);
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kNone);
}

TEST(FalconControl, TellsTheButtons) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.emulator.press(0b0101);
  rig.run(1, {});
  EXPECT_EQ(rig.control.sample()->buttons, 0b0101U);
}

TEST(FalconControl, BeforeHomingThereIsNoSampleAndNoForceAndEveryPacketAsksForHoming) {
  FalconRig rig;
  for (const unsigned homed : {0U, 1U, 2U, 3U, 4U, 5U, 6U}) {
    rig.emulator.set_homed(homed);
    for (int i = 0; i < 200; ++i) {
      rig.run(1, kPush);
      ASSERT_TRUE(rig.motors_rest());
      ASSERT_EQ(rig.emulator.flags() & 1U, 1U);
    }
    EXPECT_FALSE(rig.control.sample());
    EXPECT_EQ(rig.control.hold(rig.now), Hold::kNotHomed);
  }
}

TEST(FalconControl, ItsLedIsRedThenBlueThenGreenWhileForceIsWanted) {
  FalconRig rig;
  rig.run(2, {});
  EXPECT_EQ(rig.emulator.flags(), kRed);
  rig.settle_at(kCentre);
  rig.run(1100, {});
  EXPECT_EQ(rig.emulator.flags(), kBlue);
  rig.run(2, kPush);
  EXPECT_EQ(rig.emulator.flags(), kGreen);
  rig.run(990, {});
  EXPECT_EQ(rig.emulator.flags(), kGreen) << "a contact that ends does not make it flicker";
  rig.run(20, {});
  EXPECT_EQ(rig.emulator.flags(), kBlue);
}

TEST(FalconControl, ShowsWhichOneItIsByGreenAndRedInTurnForThreeSeconds) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.run(1100, {});
  rig.control.identify(rig.now);
  int green = 0;
  int red = 0;
  for (int i = 0; i < 2990; ++i) {
    rig.run(1, {});
    green += rig.emulator.flags() == kGreen ? 1 : 0;
    red += rig.emulator.flags() == kRed ? 1 : 0;
  }
  EXPECT_EQ(green + red, 2990);
  EXPECT_GT(green, 1300);
  EXPECT_GT(red, 1300);
  rig.run(20, {});
  EXPECT_EQ(rig.emulator.flags(), kBlue);
}

TEST(FalconControl, HomedAgainItAsksForNoHomingUntilTheMarksAreForgottenAndTrustsNoPositionBeforeNewOnes) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.control.home(rig.now);
  EXPECT_FALSE(rig.control.sample());
  rig.run(2, kPush);
  EXPECT_EQ(rig.emulator.homed(), 0U);
  for (int i = 0; i < 2000; ++i) {
    rig.run(1, kPush);
    ASSERT_EQ(rig.control.hold(rig.now), Hold::kNotHomed);
    ASSERT_TRUE(rig.motors_rest());
    ASSERT_EQ(rig.emulator.flags(), kRed) << "it asks for homing again";
  }
  rig.settle_at(kCentre);
  EXPECT_TRUE(rig.control.sample());
}

TEST(FalconControl, AFirmwareThatKeepsItsMarksIsTrustedWithThemAgainAfterASecond) {
  FalconRig rig;
  rig.emulator.troubles.keeps_marks = true;
  rig.settle_at(kCentre);
  rig.control.home(rig.now);
  for (int i = 0; i < 990; ++i) {
    rig.run(1, kPush);
    ASSERT_EQ(rig.control.hold(rig.now), Hold::kNotHomed);
    ASSERT_TRUE(rig.motors_rest());
    ASSERT_EQ(rig.emulator.flags() & 1U, i < 199 ? 0U : 1U) << i;
  }
  rig.run(20 + kSettlingReplies, {});
  EXPECT_TRUE(rig.control.sample());
}

TEST(FalconControl, TheHandGetsTheForceThatIsWanted) {
  FalconRig rig;
  rig.settle_at({0.01, -0.02, 0.12});
  for (const glm::dvec3 force : {glm::dvec3(2, 0, 0), glm::dvec3(0, -1, 0.5), glm::dvec3(0.3, 0.4, -1.5)}) {
    rig.run(1, force);
    // half a word at each motor, of at least 200 words a newton
    EXPECT_NEAR(glm::distance(rig.emulator.force(), force), 0.0, 3 * 0.5 / 200.0);
  }
}

TEST(FalconControl, NoForceIsAboveItsLimitAndTheDirectionStays) {
  FalconRig rig({.max_force = 1.5});
  rig.settle_at(kCentre);
  rig.run(1, {30.0, 40.0, 0.0});
  EXPECT_NEAR(glm::distance(rig.emulator.force(), glm::dvec3(0.9, 1.2, 0.0)), 0.0, 0.01);
}

TEST(FalconControl, LosingTheHomingOfOneEncoderDropsForceWithTheNextPacket) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.run(2, kPush);
  ASSERT_FALSE(rig.motors_rest());
  rig.emulator.set_homed(5);
  rig.run(1, kPush);  // whose reply tells it
  rig.run(1, kPush);
  EXPECT_TRUE(rig.motors_rest());
  EXPECT_FALSE(rig.control.sample());
}

TEST(FalconControl, RepliesThatStopEndForceAfterFiveMilliseconds) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.run(1, kPush);
  rig.emulator.troubles.silent = true;
  rig.run(5, kPush);  // the last reply is 4.5 ms old
  EXPECT_FALSE(rig.motors_rest());
  rig.run(1, kPush);
  EXPECT_TRUE(rig.motors_rest());
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kNoReply);
}

TEST(FalconControl, AForceThatExpiredIsZeroWhateverItSays) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.run(1, kPush);
  ASSERT_FALSE(rig.motors_rest());
  rig.exchange({.expires = rig.now, .force = kPush});
  EXPECT_TRUE(rig.motors_rest());
}

TEST(FalconControl, ForceComesBackGentlyAfterItWasHeldBack) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.run(1, kPush);
  const double full = rig.emulator.force().z;
  rig.exchange({});
  ASSERT_TRUE(rig.motors_rest());
  // the ramp is 50 ms: after 10 packets a fifth of the force
  rig.run(10, kPush);
  EXPECT_NEAR(rig.emulator.force().z, full / 5.0, 0.01);
  rig.run(40, kPush);
  EXPECT_NEAR(rig.emulator.force().z, full, 0.01);
}

TEST(FalconControl, AJumpOfACountDropsForceUntilFiftyGoodReplies) {
  FalconRig rig;
  rig.emulator.set_homed(kAllHomed);
  rig.emulator.turn_to({0, 0, 0});
  rig.run(120, {0.1, 0.0, 0.0});
  ASSERT_EQ(rig.control.hold(rig.now), Hold::kNone);
  rig.emulator.turn_to({0, kMostCountsPerMillisecond, 0});
  rig.run(1, kPush);
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kNone) << "as fast as a hand can";
  rig.emulator.turn_to({0, 2 * kMostCountsPerMillisecond + 1, 0});
  rig.run(1, kPush);
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kJump);
  EXPECT_FALSE(rig.control.sample());
  rig.run(kSettlingReplies, kPush);
  EXPECT_TRUE(rig.motors_rest());
  EXPECT_FALSE(rig.control.sample());
  rig.run(1, kPush);
  EXPECT_TRUE(rig.control.sample());
  rig.run(1, kPush);
  EXPECT_FALSE(rig.motors_rest());
}

TEST(FalconControl, AnglesThatNoPlaceHasDropForce) {
  FalconRig rig;
  rig.emulator.set_homed(kAllHomed);
  rig.emulator.turn_to({-3200, 2000, 2000});
  for (int i = 0; i < 200; ++i) {
    rig.run(1, kPush);
    ASSERT_TRUE(rig.motors_rest());
  }
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kUnsolvable);
  EXPECT_FALSE(rig.control.sample());
}

TEST(FalconControl, OutsideTheTrustedBoxThereIsAPositionButNoForce) {
  FalconRig rig;
  rig.settle_at({0.0, 0.0, 0.1});
  rig.run(1, kPush);
  ASSERT_FALSE(rig.motors_rest());
  for (double z = 0.1; z > 0.066; z -= 0.0005) {
    rig.emulator.hold_at({0.0, 0.0, z});
    rig.run(1, kPush);
  }
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kOutside);
  ASSERT_TRUE(rig.control.sample());
  EXPECT_NEAR(rig.control.sample()->position.z, 0.0665, 6e-4);
  rig.run(1, kPush);
  EXPECT_TRUE(rig.motors_rest());
}

TEST(FalconControl, RepliesMayBeSeveralMillisecondsOnTheirWay) {
  FalconRig rig;
  rig.delay = 4;
  rig.emulator.set_homed(kAllHomed);
  rig.emulator.hold_at(kCentre);
  rig.run(120, {1e-9, 0.0, 0.0});
  rig.run(1, kPush);
  EXPECT_NEAR(rig.emulator.force().z, kPush.z, 0.01);
}

TEST(FalconControl, GarbageBetweenRepliesCostsNone) {
  FalconRig rig;
  rig.emulator.troubles.garbage = 13;
  rig.settle_at(kCentre);
  rig.run(100, kPush);
  EXPECT_EQ(rig.control.replies(), rig.emulator.packets());
  EXPECT_EQ(rig.control.skipped_bytes(), 13 * rig.emulator.packets());
  EXPECT_EQ(rig.emulator.broken_bytes(), 0U);
}

// Drawn at 0.1 m/s the velocity settles on that; what a count adds in a millisecond is smoothed.
TEST(FalconControl, VelocityIsThatOfTheGrip) {
  FalconRig rig;
  rig.settle_at({0.0, 0.0, 0.11});
  for (int i = 0; i < 200; ++i) {
    rig.emulator.hold_at({0.0, 0.0, 0.11 + 1e-4 * i});
    rig.run(1, {});
  }
  EXPECT_NEAR(glm::distance(rig.control.sample()->velocity, glm::dvec3(0.0, 0.0, 0.1)), 0.0, 0.03);
}

TEST(FalconControl, AForceThatIsNoNumberIsNone) {
  FalconRig rig;
  rig.settle_at(kCentre);
  rig.run(1, {std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0});
  EXPECT_TRUE(rig.motors_rest());
  rig.run(1, {std::numeric_limits<double>::infinity(), 0.0, 1.0});
  EXPECT_TRUE(rig.motors_rest());
}

TEST(FalconControl, IsRealTimeSafe) {
  FalconRig rig;
  rig.settle_at(kCentre);
  std::vector<std::uint8_t> replies;
  rig.emulator.receive(encode({}));
  replies = rig.emulator.send(1000);
  const rt::AllocationGuard watch;
  for (int i = 0; i < 1000; ++i) {
    rig.now += kMillisecond;
    (void)rig.control.next_packet({.expires = rig.now + kMillisecond, .force = kPush}, rig.now);
    rig.control.take(replies, rig.now);
  }
}

}  // namespace
}  // namespace haptic::drivers::falcon
