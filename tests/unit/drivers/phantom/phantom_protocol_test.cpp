#include "drivers/phantom/phantom_protocol.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/drivers/phantom/phantom_arm.h"

namespace haptic::drivers::phantom {
namespace {

TEST(PhantomProtocol, LooksAtTheRegistersOfEncodersAndButtonOnly) {
  RegisterMap map = toy_calibration().map;
  EXPECT_EQ(inputs_of(map), 0b0101'1100U);
  EXPECT_EQ(outputs_of(map), 0b0000'0111U);
  map.button.reset();
  EXPECT_EQ(inputs_of(map), 0b0001'1100U);
}

TEST(PhantomProtocol, AButtonIsOneBitEitherWayRound) {
  RegisterMap map = toy_calibration().map;
  Registers inputs{};
  inputs[6] = 0x2;
  EXPECT_TRUE(is_pressed(map, inputs));
  inputs[6] = ~0x2U;
  EXPECT_FALSE(is_pressed(map, inputs));
  map.button->is_low = true;
  EXPECT_TRUE(is_pressed(map, inputs));
  map.button.reset();
  EXPECT_FALSE(is_pressed(map, inputs));
}

TEST(PhantomProtocol, CountersWrapAtTheirBits) {
  EXPECT_EQ(counted(0xFFFF, 0x0002, 16), 3);
  EXPECT_EQ(counted(0x0002, 0xFFFF, 16), -3);
  EXPECT_EQ(counted(0x0000, 0x7FFF, 16), 32767);
  EXPECT_EQ(counted(0x0000, 0x8000, 16), -32768);
  EXPECT_EQ(counted(250, 5, 8), 11);
  EXPECT_EQ(counted(0xFFFFFFFF, 1, 32), 2);
}

TEST(PhantomProtocol, BitsAboveTheCounterDoNotCount) {
  EXPECT_EQ(counted(0x12340010, 0xABCD0013, 16), 3);
  EXPECT_EQ(counted(static_cast<std::uint32_t>(-5), 0x0000FFFF, 16), 4) << "a rest count below zero";
}

TEST(PhantomProtocol, WordsAreOffsetBy2048AndGoToTheMotorsRegisters) {
  const Registers outputs = words_for(toy_calibration().map, {100.4, -300.6, 1024.0});
  EXPECT_EQ(outputs[1], 2148U);
  EXPECT_EQ(outputs[2], 1747U);
  EXPECT_EQ(outputs[0], 3072U);
  for (std::size_t i = 3; i < 8; ++i) EXPECT_EQ(outputs[i], kNoTorque);
}

TEST(PhantomProtocol, AWordThatIsTooLargeScalesAllOfThem) {
  const Registers outputs = words_for(toy_calibration().map, {2048.0, -1024.0, 512.0});
  EXPECT_EQ(outputs[1], 2048U + 1024U);
  EXPECT_EQ(outputs[2], 2048U - 512U);
  EXPECT_EQ(outputs[0], 2048U + 256U);
}

TEST(PhantomProtocol, NoWordLeavesTheConverter) {
  RegisterMap map = toy_calibration().map;
  map.largest_words = {4000000000U, 4000000000U, 4000000000U};
  EXPECT_EQ(words_for(map, {1e300, 0.0, 0.0})[1], 4095U);
  EXPECT_EQ(words_for(map, {-1e300, 0.0, 0.0})[1], 1U);
}

TEST(PhantomProtocol, WhatIsNoNumberIsNoTorqueAtAll) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(words_for(toy_calibration().map, {10.0, bad, 10.0}), no_torque());
  }
}

}  // namespace
}  // namespace haptic::drivers::phantom
