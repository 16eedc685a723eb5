#include "drivers/polhem/polhem_control.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

#include "tests/unit/drivers/polhem/polhem_messages.h"

namespace haptic::drivers::polhem {
namespace {

constexpr Joints kRest = {0, 0, 6000};
const ForceCommand kPush{.expires = 1, .force = {0.0, 0.0, 2.0}};

TEST(PolhemControl, WithoutCalibrationThereIsNoSampleAndNoForce) {
  PolhemControl control({.rest_counts = kRest});
  for (Nanoseconds now = 0; now < 100; ++now) {
    control.take({.counts = kRest}, now);
    EXPECT_FALSE(control.sample());
    EXPECT_EQ(control.answer(kPush), currents_message({}));
  }
}

TEST(PolhemControl, TheButtonPresetsTheCountersUntilTheyAreSeenToBe) {
  PolhemControl control({.rest_counts = kRest});
  control.take({.counts = {17, -40, 123}, .calibrate = true}, 1);
  EXPECT_EQ(control.answer(kPush), preset_message(kRest));
  control.take({.counts = {17, -40, 123}, .calibrate = false}, 2);
  EXPECT_EQ(control.answer(kPush), preset_message(kRest)) << "it was lost: again";
  EXPECT_FALSE(control.sample());
  control.take({.counts = {0, 3, 5990}}, 3);
  ASSERT_TRUE(control.sample());
  EXPECT_EQ(control.sample()->time, 3);
  EXPECT_NEAR(control.sample()->position.z, 0.205, 1e-3);
}

TEST(PolhemControl, CalibratesAtTheFirstReadingIfItShall) {
  PolhemControl control({.rest_counts = kRest, .calibrate_at_start = true});
  control.take({.counts = {5, 5, 5}}, 1);
  EXPECT_EQ(control.answer({}), preset_message(kRest));
  control.take({.counts = kRest}, 2);
  EXPECT_TRUE(control.sample());
}

TEST(PolhemControl, TheForceIsThatOfTheCurrentsAndNoMoreThanItsLimit) {
  PolhemControl control(
      {.rest_counts = kRest, .calibrate_at_start = true, .max_current = 6.0, .max_force = 3.0});
  control.take({}, 1);
  control.take({.counts = kRest}, 2);
  // at rest A turns sideways about R = 0.245 m, B pushes x by Lb = 0.205 m, C pushes z by Lc = 0.245 m
  for (const double wanted : {2.0, 30.0}) {
    const Message message = control.answer({.expires = 1, .force = {0.0, 0.0, wanted}});
    const double torque = word_of(message, 2) * 1e-3 * 0.0603 * 12.0;
    EXPECT_NEAR(torque / 0.245, std::min(wanted, 3.0), 0.5e-3 * 0.0603 * 12.0 / 0.245);
    EXPECT_EQ(word_of(message, 0), 0);
    EXPECT_EQ(word_of(message, 1), 0);
  }
}

TEST(PolhemControl, AForceThatIsNoNumberIsNone) {
  PolhemControl control({.rest_counts = kRest, .calibrate_at_start = true});
  control.take({}, 1);
  control.take({.counts = kRest}, 2);
  EXPECT_EQ(control.answer({.expires = 1, .force = {std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0}}),
            currents_message({}));
}

TEST(PolhemControl, WhatCannotBeSentToIsTakenAsItCounts) {
  PolhemControl control({.presets_itself = false});
  control.take({.counts = kRest}, 1);
  ASSERT_TRUE(control.sample());
  EXPECT_NEAR(control.sample()->position.z, 0.205, 1e-12);
}

}  // namespace
}  // namespace haptic::drivers::polhem
