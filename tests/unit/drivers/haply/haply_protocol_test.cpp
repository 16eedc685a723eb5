#include "drivers/haply/haply_protocol.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace haptic::drivers::haply {
namespace {

using Bytes = std::vector<std::uint8_t>;

// 12 = 0x41400000, 168 = 0x43280000, 4880 = 0x45988000
TEST(HaplyProtocol, SetsUpBothPortsWithoutSensorsAndPwm) {
  const auto message = setup_message(kWiring3);
  EXPECT_EQ(Bytes(message.begin(), message.end()),
            (Bytes{1, 5, 3,    1,    1, 3,    1,    1,    0, 0,  // blocks
                   0, 0, 0x40, 0x41, 0, 0x80, 0x98, 0x45,        // port 1
                   0, 0, 0x28, 0x43, 0, 0x80, 0x98, 0x45}));     // port 2
}

// 1 = 0x3F800000, -0.5 = 0xBF000000; joint 1 is on port 2
TEST(HaplyProtocol, SendsTorquesInTheOrderOfPorts) {
  const auto message = request_message({1.0, -0.5});
  EXPECT_EQ(Bytes(message.begin(), message.end()), (Bytes{2, 5, 0, 0, 0, 0xBF, 0, 0, 0x80, 0x3F}));
}

TEST(HaplyProtocol, ReadsDegreesInTheOrderOfPorts) {
  // 90 = 0x42B40000 on port 1, which is joint 2; -45 = 0xC2340000 on port 2
  const auto angles = decode(Bytes{5, 0, 0, 0xB4, 0x42, 0, 0, 0x34, 0xC2});
  ASSERT_TRUE(angles);
  EXPECT_NEAR((*angles)[0], -std::numbers::pi / 4.0, 1e-12);
  EXPECT_NEAR((*angles)[1], std::numbers::pi / 2.0, 1e-12);
}

TEST(HaplyProtocol, WhatIsNoReplyIsRefused) {
  EXPECT_FALSE(decode(Bytes{}));
  EXPECT_FALSE(decode(Bytes{5, 0, 0, 0, 0, 0, 0, 0})) << "short";
  EXPECT_FALSE(decode(Bytes{4, 0, 0, 0, 0, 0, 0, 0, 0})) << "another device";
  EXPECT_FALSE(decode(Bytes{5, 0, 0, 0xC0, 0x7F, 0, 0, 0, 0})) << "not a number";
  EXPECT_FALSE(decode(Bytes{5, 0, 0, 0, 0, 0, 0, 0x80, 0x7F})) << "infinite";
  EXPECT_FALSE(decode(Bytes{5, 0, 0, 0x80, 0x45, 0, 0, 0, 0})) << "4096 degrees";
}

}  // namespace
}  // namespace haptic::drivers::haply
