// The bytes and words of the protocol, as its specification gives them.

#include "client/view/foxglove_messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace haptic::gateway::foxglove_protocol {
namespace {

using nlohmann::json;

TEST(Base64, IsThatOfRfc4648) {
  // section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xfb\xff\xbf"), "+/+/");
}

TEST(FoxgloveServer, TellsWhoItIsAndThatItOnlyShows) {
  const json told = json::parse(server_info("haptic-view", "123"));
  EXPECT_EQ(told, json::parse(R"({"op": "serverInfo", "name": "haptic-view", "capabilities": [],
                                  "sessionId": "123"})"));
}

TEST(FoxgloveServer, AdvertisesAChannelWithItsSchema) {
  const Channel channel{.id = 3, .topic = "/tf", .schema_name = "a.B", .schema = "foob"};
  const json told = json::parse(advertise({&channel, 1}));
  EXPECT_EQ(told, json::parse(R"({"op": "advertise", "channels": [{"id": 3, "topic": "/tf",
      "encoding": "protobuf", "schemaName": "a.B", "schemaEncoding": "protobuf", "schema": "Zm9vYg=="}]})"));
}

TEST(FoxgloveServer, TellsAStatusThatCanBeTakenBack) {
  EXPECT_EQ(json::parse(status(Level::kError, "gone", "daemon")),
            json::parse(R"({"op": "status", "level": 2, "message": "gone", "id": "daemon"})"));
  EXPECT_EQ(json::parse(status(Level::kWarning, "hm")),
            json::parse(R"({"op": "status", "level": 1, "message": "hm"})"));
  EXPECT_EQ(json::parse(remove_status("daemon")),
            json::parse(R"({"op": "removeStatus", "statusIds": ["daemon"]})"));
}

TEST(FoxgloveServer, SaysNothingButUtf8) {
  EXPECT_EQ(json::parse(status(Level::kInfo, "a\xff")).at("message"), "a\xef\xbf\xbd");
}

TEST(FoxgloveServer, PutsOpcodeSubscriptionAndTimeBeforeAMessageLittleEndian) {
  EXPECT_EQ(message_head(0x04030201, 0x0c0b0a0908070605),
            std::string("\x01\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c", 13));
}

TEST(FoxgloveClient, Subscribes) {
  const Request request = parse_text(
      R"({"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 3}, {"id": 4294967295, "channelId": 1}]})");
  const auto& wish = std::get<Subscribe>(request);
  ASSERT_EQ(wish.subscriptions.size(), 2U);
  EXPECT_EQ(wish.subscriptions[0].id, 0U);
  EXPECT_EQ(wish.subscriptions[0].channel, 3U);
  EXPECT_EQ(wish.subscriptions[1].id, 4294967295U);
}

TEST(FoxgloveClient, Unsubscribes) {
  const Request request = parse_text(R"({"op": "unsubscribe", "subscriptionIds": [1, 2]})");
  EXPECT_EQ(std::get<Unsubscribe>(request).ids, (std::vector<std::uint32_t>{1, 2}));
}

TEST(FoxgloveClient, IsToldWhatItSaidWrong) {
  for (const char* const text :
       {"",
        "{",
        "[]",
        "1",
        "null",
        "\"subscribe\"",
        "{}",
        R"({"op": 1})",
        R"({"op": "dance"})",
        R"({"op": "subscribe"})",
        R"({"op": "subscribe", "subscriptions": 1})",
        R"({"op": "subscribe", "subscriptions": [1]})",
        R"({"op": "subscribe", "subscriptions": [{}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1.5, "channelId": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 4294967296, "channelId": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": "1", "channelId": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1e400, "channelId": 1}]})",
        R"({"op": "unsubscribe"})",
        R"({"op": "unsubscribe", "subscriptionIds": {}})",
        R"({"op": "unsubscribe", "subscriptionIds": [null]})",
        "{\"op\": \"\xff\"}"}) {
    const Request request = parse_text(text);
    ASSERT_TRUE(std::holds_alternative<Invalid>(request)) << text;
    EXPECT_NE(std::get<Invalid>(request).why, "");
  }
}

TEST(FoxgloveClient, BearsDeepNesting) {
  const std::string deep(60'000, '[');
  EXPECT_TRUE(std::holds_alternative<Invalid>(parse_text(deep)));
  EXPECT_TRUE(std::holds_alternative<Invalid>(parse_text(deep + std::string(60'000, ']'))));
}

TEST(FoxgloveClient, MayAskForWhatIsNotOffered) {
  for (const char* const op : {"advertise", "getParameters", "subscribeConnectionGraph", "fetchAsset"}) {
    EXPECT_TRUE(std::holds_alternative<Unsupported>(parse_text(R"({"op": ")" + std::string(op) + "\"}")))
        << op;
  }
}

TEST(FoxgloveClient, HasBytesForWhatIsNotOfferedOnly) {
  EXPECT_TRUE(std::holds_alternative<Nothing>(parse_bytes("")));
  for (const char opcode : {'\x01', '\x02', '\x03'}) {
    EXPECT_TRUE(std::holds_alternative<Unsupported>(parse_bytes(std::string(1, opcode)))) << int{opcode};
  }
  for (const char opcode : {'\x00', '\x04', '\xff'}) {
    EXPECT_TRUE(std::holds_alternative<Invalid>(parse_bytes(std::string(1, opcode)))) << int{opcode};
  }
}

}  // namespace
}  // namespace haptic::gateway::foxglove_protocol
