#include "client/view/foxglove_viewer.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace haptic::gateway {
namespace {

using nlohmann::json;

Payload payload(const std::string& text) { return std::make_shared<const std::string>(text); }

std::string wish(std::uint32_t id, Topic topic) {
  return json{
      {"op", "subscribe"},
      {"subscriptions", json::array({{{"id", id}, {"channelId", static_cast<std::uint32_t>(topic)}}})}}
      .dump();
}

std::string end_of(std::uint32_t id) {
  return json{{"op", "unsubscribe"}, {"subscriptionIds", json::array({id})}}.dump();
}

// what waits, each as head and payload
std::vector<std::string> all_of(FoxgloveViewer& viewer) {
  std::vector<std::string> all;
  while (const auto next = viewer.take()) {
    all.push_back(next->head + (next->payload ? *next->payload : ""));
  }
  return all;
}

std::string message(std::uint32_t subscription, std::uint64_t time, const std::string& text) {
  return foxglove_protocol::message_head(subscription, time) + text;
}

TEST(FoxgloveChannels, HaveNumbersTopicsAndSchemas) {
  const auto channels = all_channels();
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"/tf", "foxglove.FrameTransforms"},  {"/scene", "foxglove.SceneUpdate"},
      {"/haptic/frame", "haptic.v1.Frame"}, {"/log", "foxglove.Log"},
      {"/stats", "haptic.v1.Stats"},
  };
  for (std::size_t i = 0; i < kTopics; ++i) {
    EXPECT_EQ(channels[i].id, i + 1);
    EXPECT_EQ(channels[i].topic, expected[i].first);
    EXPECT_EQ(channels[i].schema_name, expected[i].second);
  }
}

TEST(FoxgloveChannels, HaveSchemasThatStandAlone) {
  for (const auto& channel : all_channels()) {
    google::protobuf::FileDescriptorSet set;
    ASSERT_TRUE(set.ParseFromString(channel.schema));
    google::protobuf::DescriptorPool pool;
    for (const auto& file : set.file()) {
      ASSERT_NE(pool.BuildFile(file), nullptr) << file.name();
    }
    EXPECT_NE(pool.FindMessageTypeByName(channel.schema_name), nullptr);
  }
}

TEST(FoxgloveViewer, GetsWhatItHasSubscribedToUnderItsOwnNumber) {
  FoxgloveViewer viewer;
  viewer.take_text(wish(70, Topic::kFrame));
  EXPECT_TRUE(viewer.wants(Topic::kFrame));
  EXPECT_FALSE(viewer.wants(Topic::kStats));
  viewer.set(Slot::kFrame, payload("frame"), 5);
  viewer.set(Slot::kStats, payload("stats"), 6);
  viewer.log(payload("log"), 7);
  EXPECT_EQ(all_of(viewer), std::vector{message(70, 5, "frame")});
}

TEST(FoxgloveViewer, GetsTheNewestOfWhatWaits) {
  FoxgloveViewer viewer;
  viewer.take_text(wish(1, Topic::kFrame));
  viewer.take_text(wish(2, Topic::kPlaces));
  for (std::uint64_t time = 1; time <= 1000; ++time) {
    viewer.set(Slot::kFrame, payload("frame"), time);
  }
  viewer.set(Slot::kPlaces, payload("places"), 1);
  const auto got = all_of(viewer);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_NE(std::find(got.begin(), got.end(), message(1, 1000, "frame")), got.end());
  EXPECT_NE(std::find(got.begin(), got.end(), message(2, 1, "places")), got.end());
}

// shapes come once, HIPs all the time, in one topic
TEST(FoxgloveViewer, DoesNotLoseShapesToNewerHips) {
  FoxgloveViewer viewer;
  viewer.take_text(wish(1, Topic::kScene));
  viewer.set(Slot::kShapes, payload("shapes"), 1);
  viewer.set(Slot::kHips, payload("hips"), 2);
  viewer.set(Slot::kHips, payload("hips"), 3);
  EXPECT_EQ(all_of(viewer), (std::vector{message(1, 1, "shapes"), message(1, 3, "hips")}));
}

TEST(FoxgloveViewer, LacksShapesOnceForEachSubscriptionToTheScene) {
  FoxgloveViewer viewer;
  viewer.take_text(wish(1, Topic::kFrame));
  EXPECT_FALSE(viewer.lacks_shapes());
  viewer.take_text(wish(2, Topic::kScene));
  EXPECT_TRUE(viewer.lacks_shapes());
  EXPECT_FALSE(viewer.lacks_shapes());
  viewer.take_text(end_of(2));
  viewer.take_text(wish(3, Topic::kScene));
  EXPECT_TRUE(viewer.lacks_shapes());
}

TEST(FoxgloveViewer, GetsEachTopicInTurnHoweverOftenOneComes) {
  FoxgloveViewer viewer;
  for (std::uint32_t i = 1; i <= kTopics; ++i) {
    viewer.take_text(wish(i, static_cast<Topic>(i)));
  }
  viewer.set(Slot::kStats, payload("stats"), 1);
  bool has_come = false;
  for (int i = 0; i < 5 && !has_come; ++i) {
    viewer.set(Slot::kPlaces, payload("places"), 2);
    viewer.set(Slot::kFrame, payload("frame"), 2);
    has_come = viewer.take()->head == foxglove_protocol::message_head(5, 1);
  }
  EXPECT_TRUE(has_come);
}

TEST(FoxgloveViewer, KeepsTheNewestWordsOnly) {
  FoxgloveViewer viewer;
  viewer.take_text(wish(9, Topic::kLog));
  for (std::uint64_t time = 1; time <= 100; ++time) {
    viewer.log(payload("log"), time);
  }
  const auto got = all_of(viewer);
  ASSERT_EQ(got.size(), FoxgloveViewer::kMostWords);
  EXPECT_EQ(got.front(), message(9, 101 - FoxgloveViewer::kMostWords, "log"));
  EXPECT_EQ(got.back(), message(9, 100, "log"));
}

TEST(FoxgloveViewer, GetsNothingMoreOfWhatItHasLeft) {
  FoxgloveViewer viewer;
  viewer.take_text(wish(1, Topic::kFrame));
  viewer.take_text(wish(2, Topic::kLog));
  viewer.set(Slot::kFrame, payload("frame"), 1);
  viewer.log(payload("log"), 1);
  viewer.take_text(end_of(1));
  viewer.take_text(end_of(2));
  viewer.take_text(end_of(77));
  EXPECT_TRUE(all_of(viewer).empty());
  EXPECT_FALSE(viewer.wants(Topic::kFrame));
}

// the rest of the list applies
TEST(FoxgloveViewer, IsToldOfEachSubscriptionThatCannotBe) {
  FoxgloveViewer viewer;
  viewer.take_text(
      R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 3}, {"id": 2, "channelId": 3},
      {"id": 1, "channelId": 4}, {"id": 5, "channelId": 0}, {"id": 6, "channelId": 6}, {"id": 7, "channelId": 5}]})");
  const auto told = all_of(viewer);
  ASSERT_EQ(told.size(), 4U);
  EXPECT_EQ(json::parse(told[0]).at("level"), 1);
  for (std::size_t i = 1; i < told.size(); ++i) {
    EXPECT_EQ(json::parse(told[i]).at("level"), 2);
  }
  EXPECT_TRUE(viewer.wants(Topic::kFrame));
  EXPECT_FALSE(viewer.wants(Topic::kLog));
  EXPECT_TRUE(viewer.wants(Topic::kStats));
}

TEST(FoxgloveViewer, IsToldWhatItSaidWrongAndGoesOn) {
  FoxgloveViewer viewer;
  viewer.take_text("nonsense");
  viewer.take_bytes(
      "\x01"
      "abcd");
  viewer.take_bytes("");
  EXPECT_EQ(all_of(viewer).size(), 2U);
  for (int i = 0; i < 1000; ++i) {
    viewer.take_text("nonsense");
  }
  EXPECT_EQ(all_of(viewer).size(), FoxgloveViewer::kMostWords);
}

}  // namespace
}  // namespace haptic::gateway
