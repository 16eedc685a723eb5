#include "drivers/phantom/phantom_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rt/allocation_guard.h"
#include "tests/unit/drivers/phantom/phantom_arm.h"

namespace haptic::drivers::phantom {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

class Rig {
 public:
  explicit Rig(const Calibration& calibration = toy_calibration(), double max_force = 5.0)
      : control({.calibration = calibration, .max_force = max_force}) {}

  /// One round a millisecond with these registers, and this force wanted (N).
  Registers run(int rounds, const Registers& inputs, const glm::dvec3& force = {}) {
    Registers outputs{};
    for (int i = 0; i < rounds; ++i) {
      now += kMillisecond;
      control.take(inputs, now);
      outputs = control.next_outputs({.expires = now + 3 * kMillisecond, .force = force}, now);
    }
    return outputs;
  }

  /// The same without a new reading.
  Registers push(const glm::dvec3& force) {
    now += kMillisecond;
    return control.next_outputs({.expires = now + 3 * kMillisecond, .force = force}, now);
  }

  Nanoseconds now = 0;
  PhantomControl control;
};

constexpr int kSettled = kSettlingReadings + 1;
constexpr int kRampedIn = kSettled + 60;
const glm::dvec3 kRight(1.0, 0.0, 0.0);

TEST(PhantomControl, TheFirstReadingIsTheRestPoseIfTheCalibrationSaysSo) {
  Calibration calibration = toy_calibration();
  calibration.rest_angles = {0.0, 0.0, 0.5};
  Rig rig(calibration);
  rig.run(kSettled, toy_inputs(123, -45, 6));
  ASSERT_TRUE(rig.control.sample());
  EXPECT_EQ(rig.control.sample()->position, finger_position(calibration.geometry, {0.0, 0.0, 0.5}));
  EXPECT_EQ(rig.control.sample()->velocity, glm::dvec3(0.0));
}

// 200 counts of 1000 for a radian; the upper arm counts downwards
TEST(PhantomControl, CountsAreAnglesFromTheRestPose) {
  Rig rig;
  rig.run(kSettled, toy_inputs(0, 0, 0));
  for (std::int16_t count = 0; count <= 200; count = static_cast<std::int16_t>(count + 10)) {
    rig.run(1, toy_inputs(count, static_cast<std::int16_t>(-count), 0));
  }
  ASSERT_TRUE(rig.control.sample());
  EXPECT_NEAR(glm::length(rig.control.sample()->position - finger_position({0.2, 0.15}, {0.2, 0.2, 0.0})),
              0.0, 1e-15);
}

TEST(PhantomControl, CountersMayWrapWhileTheArmMoves) {
  Rig rig;
  rig.run(kSettled, toy_inputs(32760, 0, 0));
  rig.run(1, toy_inputs(-32766, 0, 0));  // 10 counts on
  ASSERT_TRUE(rig.control.sample());
  EXPECT_NEAR(glm::length(rig.control.sample()->position - finger_position({0.2, 0.15}, {0.01, 0.0, 0.0})),
              0.0, 1e-15);
}

TEST(PhantomControl, CountsThatTheCardKeepsNeedNoRestPose) {
  Calibration calibration = toy_calibration();
  calibration.reference = Reference::kCountsAreKept;
  calibration.rest_counts = {-100, 0, 0};
  Rig rig(calibration);
  rig.run(kSettled, toy_inputs(100, 0, 0));
  ASSERT_TRUE(rig.control.sample());
  EXPECT_NEAR(glm::length(rig.control.sample()->position - finger_position({0.2, 0.15}, {0.2, 0.0, 0.0})),
              0.0, 1e-15);
}

TEST(PhantomControl, WithAButtonThereIsNothingBeforeItIsPressedInTheRestPose) {
  Calibration calibration = toy_calibration();
  calibration.reference = Reference::kRestAtButton;
  Rig rig(calibration);
  EXPECT_EQ(rig.run(1000, toy_inputs(40, 0, 0), kRight), no_torque());
  EXPECT_FALSE(rig.control.sample());
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kNoReference);
  rig.run(1, toy_inputs(55, 0, 0, true));
  rig.run(kSettled, toy_inputs(55, 0, 0));
  ASSERT_TRUE(rig.control.sample());
  EXPECT_EQ(rig.control.sample()->position, glm::dvec3(0.0));
}

TEST(PhantomControl, AButtonThatWasNeverSeenReleasedTellsNoRestPose) {
  Calibration calibration = toy_calibration();
  calibration.reference = Reference::kRestAtButton;
  Rig rig(calibration);
  rig.run(1000, toy_inputs(0, 0, 0, true));
  EXPECT_FALSE(rig.control.sample());
}

TEST(PhantomControl, TellsItsButton) {
  Rig rig;
  rig.run(kSettled, toy_inputs(0, 0, 0));
  EXPECT_EQ(rig.control.sample()->buttons, 0U);
  rig.run(1, toy_inputs(0, 0, 0, true));
  EXPECT_EQ(rig.control.sample()->buttons, 1U);
}

// 1 N to the right at the origin: 0.2 N m at the base, 500 words each; the same up at the upper arm, whose
// motor goes the other way; 0.15 N m at the forearm
TEST(PhantomControl, ForceBecomesTheWordsOfItsTorques) {
  Rig rig;
  Registers outputs = rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight);
  EXPECT_EQ(outputs[1], 2148U);
  EXPECT_EQ(outputs[2], kNoTorque);
  EXPECT_EQ(outputs[0], kNoTorque);
  outputs = rig.run(1, toy_inputs(0, 0, 0), {0.0, 1.0, 0.0});
  EXPECT_EQ(outputs[1], kNoTorque);
  EXPECT_EQ(outputs[2], 1948U);
  outputs = rig.run(1, toy_inputs(0, 0, 0), {0.0, 0.0, 1.0});
  EXPECT_EQ(outputs[0], 2048U + 75U);
}

TEST(PhantomControl, AForceAboveTheLimitKeepsItsDirection) {
  Rig rig(toy_calibration(), 2.0);
  const Registers outputs = rig.run(kRampedIn, toy_inputs(0, 0, 0), {30.0, 40.0, 0.0});
  // 2 N in the same direction: 1.2 N to the right, 1.6 N up
  EXPECT_EQ(outputs[1], 2048U + 120U);
  EXPECT_EQ(outputs[2], 2048U - 160U);
}

TEST(PhantomControl, WithoutALimitThereIsNoForce) {
  Rig rig(toy_calibration(), 0.0);
  EXPECT_EQ(rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight), no_torque());
}

// one part in fifty for each millisecond: 5 N at 0.2 m are 500 words
TEST(PhantomControl, ForceIsRampedInOver50Milliseconds) {
  const glm::dvec3 force(5.0, 0.0, 0.0);
  Rig rig;
  EXPECT_EQ(rig.run(kRampedIn, toy_inputs(0, 0, 0), force)[1], 2048U + 500U);
  rig.now += 20 * kMillisecond;
  EXPECT_EQ(rig.push(force), no_torque()) << "the reading is too old";
  EXPECT_EQ(rig.run(1, toy_inputs(0, 0, 0), force)[1], 2048U + 10U);
  EXPECT_EQ(rig.run(24, toy_inputs(0, 0, 0), force)[1], 2048U + 250U);
  EXPECT_EQ(rig.run(40, toy_inputs(0, 0, 0), force)[1], 2048U + 500U);
}

TEST(PhantomControl, AnExpiredForceIsNone) {
  Rig rig;
  rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight);
  const Nanoseconds now = rig.now;
  EXPECT_NE(rig.control.next_outputs({.expires = now + 1, .force = kRight}, now), no_torque());
  EXPECT_EQ(rig.control.next_outputs({.expires = now, .force = kRight}, now), no_torque());
  EXPECT_EQ(rig.control.next_outputs({}, now), no_torque());
}

TEST(PhantomControl, AReadingTenMillisecondsOldHoldsForceBack) {
  Rig rig;
  rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight);
  EXPECT_EQ(rig.control.hold(rig.now + 9 * kMillisecond), Hold::kNone);
  EXPECT_EQ(rig.control.hold(rig.now + 10 * kMillisecond), Hold::kNoReading);
}

// 25 rad/s are 25 counts of this arm in a millisecond
TEST(PhantomControl, AnAngleThatJumpsEndsPositionAndForceUntilItHasSettled) {
  Rig rig;
  rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight);
  EXPECT_NE(rig.run(1, toy_inputs(25, 0, 0), kRight), no_torque());
  EXPECT_EQ(rig.run(1, toy_inputs(51, 0, 0), kRight), no_torque());
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kJump);
  EXPECT_FALSE(rig.control.sample());
  rig.run(kSettlingReadings, toy_inputs(51, 0, 0), kRight);
  EXPECT_FALSE(rig.control.sample());
  EXPECT_NE(rig.run(1, toy_inputs(51, 0, 0), kRight), no_torque());
  EXPECT_TRUE(rig.control.sample());
}

TEST(PhantomControl, BeyondItsAnglesAnArmHasAPositionAndNoForce) {
  Calibration calibration = toy_calibration();
  calibration.greatest_angles.z = 0.02;
  Rig rig(calibration);
  rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight);
  EXPECT_NE(rig.run(1, toy_inputs(0, 0, 20), kRight), no_torque());
  EXPECT_EQ(rig.run(1, toy_inputs(0, 0, 21), kRight), no_torque());
  EXPECT_EQ(rig.control.hold(rig.now), Hold::kOutside);
  EXPECT_TRUE(rig.control.sample());
}

TEST(PhantomControl, AForceThatIsNoNumberIsNone) {
  Rig rig;
  rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight);
  EXPECT_EQ(rig.run(1, toy_inputs(0, 0, 0), {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}),
            no_torque());
}

// 2 rad/s at 0.2 m: 2 counts in a millisecond, and the estimate lags by 4 ms
TEST(PhantomControl, TellsItsVelocity) {
  Rig rig;
  rig.run(kSettled, toy_inputs(0, 0, 0));
  for (std::int16_t count = -200; count <= 0; count = static_cast<std::int16_t>(count + 2)) {
    rig.run(count == -200 ? kSettled + 10 : 1, toy_inputs(count, 0, 0));
  }
  ASSERT_TRUE(rig.control.sample());
  EXPECT_NEAR(rig.control.sample()->velocity.x, 0.4, 0.004);
}

TEST(PhantomControl, DecidesWithoutAllocating) {
  Rig rig;
  rig.run(kRampedIn, toy_inputs(0, 0, 0), kRight);
  const rt::AllocationGuard guard;
  rig.run(10, toy_inputs(3, 0, 0), kRight);
}

}  // namespace
}  // namespace haptic::drivers::phantom
