#include "drivers/falcon/falcon_protocol.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptic::drivers::falcon {
namespace {

std::string text_of(const Packet& packet) { return {packet.begin(), packet.end()}; }

std::vector<Reply> replies_in(ReplyParser& parser, std::string_view bytes) {
  std::vector<Reply> replies;
  Reply reply;
  for (const char byte : bytes) {
    if (parser.take(static_cast<std::uint8_t>(byte), reply)) replies.push_back(reply);
  }
  return replies;
}

// encoders -500, 0, 300, all homed, centre button: -500 = 0xFE0C is MAOP, 300 = 0x012C is MCBA, 0x41 + 0x74 =
// 0xB5
constexpr std::string_view kReply =
    "<MAOPAAAAMCBA\xB5"
    "A>";
const Reply kRead{.counts = {-500, 0, 300}, .buttons = 4, .homed = kAllHomed};

TEST(FalconProtocol, WritesForcesAsNibblesTheLowestFirst) {
  EXPECT_EQ(text_of(encode({.motors = {256, -1, 0}, .homing = true, .led = Led::kGreen})),
            "<AABAPPPPAAAADA>");
  EXPECT_EQ(text_of(encode({.homing = false})), "<AAAAAAAAAAAAAA>");
}

TEST(FalconProtocol, NoMotorWordIsBeyondTheNominalRange) {
  // 4095 = 0x0FFF is PPPA, -4095 = 0xF001 is BAAP
  EXPECT_EQ(text_of(encode({.motors = {32767, -32768, 4096}, .homing = false})), "<PPPABAAPPPPAAA>");
}

TEST(FalconProtocol, EachLedHasItsBit) {
  const auto flags = [](Led led) { return encode({.homing = false, .led = led})[13] - 0x41; };
  EXPECT_EQ(flags(Led::kOff), 0);
  EXPECT_EQ(flags(Led::kGreen), 2);
  EXPECT_EQ(flags(Led::kBlue), 4);
  EXPECT_EQ(flags(Led::kRed), 8);
}

TEST(FalconProtocol, ReadsCountsButtonsAndHoming) {
  ReplyParser parser;
  EXPECT_EQ(replies_in(parser, kReply), std::vector<Reply>{kRead});
  EXPECT_EQ(parser.skipped(), 0U);
}

TEST(FalconProtocol, ReadsAReplyThatIsSplitAnywhere) {
  for (std::size_t split = 0; split <= kReply.size(); ++split) {
    ReplyParser parser;
    std::vector<Reply> replies = replies_in(parser, kReply.substr(0, split));
    for (const Reply& reply : replies_in(parser, kReply.substr(split))) replies.push_back(reply);
    EXPECT_EQ(replies, std::vector<Reply>{kRead}) << "split at " << split;
  }
}

TEST(FalconProtocol, AReplyThatBreaksOffCostsNoOther) {
  for (std::size_t length = 0; length < kReply.size(); ++length) {
    ReplyParser parser;
    const std::string bytes = std::string(kReply.substr(0, length)) + std::string(kReply);
    EXPECT_EQ(replies_in(parser, bytes), std::vector<Reply>{kRead}) << "after " << length << " bytes";
    EXPECT_EQ(parser.skipped(), length);
  }
}

TEST(FalconProtocol, ABrokenByteCostsItsReplyAndNoOther) {
  for (std::size_t at = 0; at < kReply.size(); ++at) {
    if (at == 14) continue;  // what stands there is not known
    ReplyParser parser;
    std::string broken(kReply);
    broken[at] = '\x01';
    EXPECT_EQ(replies_in(parser, broken + std::string(kReply)), std::vector<Reply>{kRead}) << "byte " << at;
    EXPECT_EQ(parser.skipped(), kReply.size());
  }
}

TEST(FalconProtocol, ForgetsHalfAReplyWhenReset) {
  ReplyParser parser;
  EXPECT_TRUE(replies_in(parser, kReply.substr(0, 8)).empty());
  parser.reset();
  EXPECT_TRUE(replies_in(parser, kReply.substr(8)).empty());
  EXPECT_EQ(replies_in(parser, kReply), std::vector<Reply>{kRead});
}

TEST(FalconProtocol, WhatIsNoReplyIsNone) {
  ReplyParser parser;
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all.append(20, static_cast<char>(byte));
  EXPECT_TRUE(replies_in(parser, all).empty());
  EXPECT_EQ(replies_in(parser, kReply), std::vector<Reply>{kRead});
}

}  // namespace
}  // namespace haptic::drivers::falcon
