#include "drivers/spacemouse/spacemouse_protocol.h"

#include <gtest/gtest.h>

#include <vector>

namespace haptic::drivers::spacemouse {
namespace {

using Bytes = std::vector<std::uint8_t>;

// 350 = 0x015E, -350 = 0xFEA2, 175 = 0x00AF
const Bytes kTranslation = {1, 0x5E, 0x01, 0xA2, 0xFE, 0xAF, 0x00};
const Bytes kRotation = {2, 0xAF, 0x00, 0x00, 0x00, 0xA2, 0xFE};

TEST(SpacemouseProtocol, SplitModelsTellTranslationAndRotationInTurn) {
  Decoder decoder;
  EXPECT_EQ(decoder.take(kTranslation), Report::kMotion);
  EXPECT_EQ(decoder.deflection().translation, glm::dvec3(1.0, -1.0, 0.5));
  EXPECT_EQ(decoder.deflection().rotation, glm::dvec3(0.0));
  EXPECT_EQ(decoder.take(kRotation), Report::kMotion);
  EXPECT_EQ(decoder.deflection().translation, glm::dvec3(1.0, -1.0, 0.5)) << "it holds";
  EXPECT_EQ(decoder.deflection().rotation, glm::dvec3(0.5, 0.0, -1.0));
}

TEST(SpacemouseProtocol, CombinedModelsTellBothAtOnce) {
  Bytes report = kTranslation;
  report.insert(report.end(), kRotation.begin() + 1, kRotation.end());
  Decoder decoder;
  EXPECT_EQ(decoder.take(report), Report::kMotion);
  EXPECT_EQ(decoder.deflection().translation, glm::dvec3(1.0, -1.0, 0.5));
  EXPECT_EQ(decoder.deflection().rotation, glm::dvec3(0.5, 0.0, -1.0));
}

TEST(SpacemouseProtocol, NoAxisIsBeyondFullDeflection) {
  Decoder decoder;
  decoder.take(Bytes{1, 0xFF, 0x7F, 0x00, 0x80, 0x90, 0x01});  // 32767, -32768, 400
  EXPECT_EQ(decoder.deflection().translation, glm::dvec3(1.0, -1.0, 1.0));
}

TEST(SpacemouseProtocol, ButtonsAreBitsOfTwoToFourBytes) {
  Decoder decoder;
  EXPECT_EQ(decoder.take(Bytes{3, 0x02, 0x00}), Report::kButtons);
  EXPECT_EQ(decoder.buttons(), 0x2U);
  decoder.take(Bytes{3, 0x01, 0x10, 0x80, 0x04});
  EXPECT_EQ(decoder.buttons(), 0x04801001U);
  decoder.take(Bytes{3, 0x00, 0x00, 0x00, 0x00, 0xFF, 0xFF});
  EXPECT_EQ(decoder.buttons(), 0U) << "bytes beyond the fourth hold no button";
}

TEST(SpacemouseProtocol, WhatIsShortOrUnknownChangesNothing) {
  Decoder decoder;
  decoder.take(kTranslation);
  for (const Bytes& report : {Bytes{}, Bytes{1}, Bytes{1, 0, 0, 0, 0, 0}, Bytes{2, 0, 0}, Bytes{3},
                              Bytes{0x17, 90, 1}, Bytes{0, 0, 0, 0, 0, 0, 0}}) {
    EXPECT_EQ(decoder.take(report), Report::kUnknown);
    EXPECT_EQ(decoder.deflection().translation, glm::dvec3(1.0, -1.0, 0.5));
    EXPECT_EQ(decoder.buttons(), 0U);
  }
}

}  // namespace
}  // namespace haptic::drivers::spacemouse
