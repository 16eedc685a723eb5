#include "proto/recording/session.h"

#include <gtest/gtest.h>

#include <memory>

#include "proto/recording/recording.h"
#include "proto/recording/schema_set.h"
#include "tests/support/memory_sink.h"

namespace haptic::recording {
namespace {

constexpr std::uint64_t kMillisecond = 1'000'000;

v1::Frame frame_at(std::uint64_t tick) {
  v1::Frame frame;
  frame.set_sequence(tick + 1);
  frame.set_tick(tick);
  frame.set_realtime_ns(tick * kMillisecond);
  frame.set_scene_revision(1);
  frame.set_armed(true);
  frame.mutable_objects()->add_position(static_cast<double>(tick));
  frame.mutable_hips()->add_contact_hip(3);
  frame.mutable_devices()->add_buttons(1);
  return frame;
}

class SessionTest : public ::testing::Test {
 protected:
  explicit SessionTest(bool viewers = true)
      : writer_(sink_, {.program = "test 1",
                        .daemon_version = "0.1.0",
                        .rate_hz = 1000.0,
                        .decimation = 2,
                        .viewers = viewers}) {}

  const Recording& close() {
    writer_.close();
    source_ = std::make_unique<MemorySource>(sink_.bytes);
    recording_ = std::make_unique<Recording>(*source_);
    return *recording_;
  }

  std::vector<v1::Frame> frames_of(const std::string& topic) const {
    std::vector<v1::Frame> frames;
    for (auto messages = recording_->messages({.topics = {topic}}); messages.next();) {
      messages.parse(frames.emplace_back());
    }
    return frames;
  }

  std::size_t count(const std::string& topic) const {
    std::size_t count = 0;
    for (auto messages = recording_->messages({.topics = {topic}}); messages.next();) {
      ++count;
    }
    return count;
  }

  test::MemorySink sink_;
  SessionWriter writer_;
  std::unique_ptr<MemorySource> source_;
  std::unique_ptr<Recording> recording_;
};

class SessionWithoutViewersTest : public SessionTest {
 protected:
  SessionWithoutViewersTest() : SessionTest(false) {}
};

TEST_F(SessionTest, EachPartOfAFrameGoesToItsChannelWithTheHeadOfTheFrame) {
  writer_.write(frame_at(7));
  close();
  for (const v1::Topic topic : {v1::OBJECTS, v1::HIPS, v1::DEVICES}) {
    const std::vector<v1::Frame> frames = frames_of(channel_of(topic));
    ASSERT_EQ(frames.size(), 1U) << topic;
    EXPECT_EQ(frames[0].tick(), 7U);
    EXPECT_EQ(frames[0].sequence(), 8U);
    EXPECT_TRUE(frames[0].armed());
    EXPECT_EQ(frames[0].has_objects(), topic == v1::OBJECTS);
    EXPECT_EQ(frames[0].has_hips(), topic == v1::HIPS);
    EXPECT_EQ(frames[0].has_devices(), topic == v1::DEVICES);
  }
  EXPECT_EQ(frames_of("/haptic/objects")[0].objects().position(0), 7.0);
  EXPECT_EQ(recording_->statistics().start_time, 7 * kMillisecond);
}

TEST_F(SessionTest, EventsAndStatisticsHaveChannelsOfTheirOwn) {
  v1::Frame event;
  event.mutable_event()->set_message("armed");
  writer_.write(event);
  v1::Frame stats;
  stats.mutable_stats()->set_tick(100);
  writer_.write(stats);
  close();
  EXPECT_EQ(frames_of("/haptic/events").at(0).event().message(), "armed");
  EXPECT_EQ(frames_of("/haptic/stats").at(0).stats().tick(), 100U);
  EXPECT_EQ(count("/foxglove/log"), 1U);
}

TEST_F(SessionTest, TellsWhoRecordedWhat) {
  const auto metadata = close().find_metadata("hapticd");
  ASSERT_TRUE(metadata);
  EXPECT_EQ(metadata->metadata.at("program"), "test 1");
  EXPECT_EQ(metadata->metadata.at("daemon_version"), "0.1.0");
  EXPECT_EQ(metadata->metadata.at("rate_hz"), "1000");
  EXPECT_EQ(metadata->metadata.at("decimation"), "2");
}

TEST_F(SessionTest, HoldsTheSceneAndGaps) {
  v1::SceneDescription scene;
  scene.set_revision(4);
  scene.mutable_scene()->add_object()->set_name("block");
  writer_.write(scene, 10);
  v1::Gap gap;
  gap.set_first_sequence(2);
  gap.set_last_sequence(5);
  writer_.write(gap, 20);
  close();
  auto scenes = recording_->messages({.topics = {kSceneTopic}});
  ASSERT_TRUE(scenes.next());
  v1::SceneDescription read;
  scenes.parse(read);
  EXPECT_EQ(read.SerializeAsString(), scene.SerializeAsString());
  auto gaps = recording_->messages({.topics = {kGapsTopic}});
  ASSERT_TRUE(gaps.next());
  v1::Gap lost;
  gaps.parse(lost);
  EXPECT_EQ(lost.last_sequence(), 5U);
  EXPECT_EQ(count("/foxglove/shapes"), 1U);
}

TEST_F(SessionTest, ViewersGetFiftyPicturesASecond) {
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    writer_.write(frame_at(tick));
  }
  close();
  EXPECT_EQ(count("/haptic/objects"), 1000U);
  EXPECT_EQ(count("/foxglove/transforms"), 50U);
  EXPECT_EQ(count("/foxglove/hips"), 50U);
}

TEST_F(SessionTest, PicturesGoOnWhenTheClockWasSetBack) {
  writer_.write(frame_at(100'000));
  writer_.write(frame_at(5));
  close();
  EXPECT_EQ(count("/foxglove/hips"), 2U);
  EXPECT_EQ(recording_->statistics().start_time, 5 * kMillisecond);
}

TEST_F(SessionTest, TimeDoesNotGoBackWhenAnEventHasOvertakenAFrame) {
  v1::Frame event;
  event.set_realtime_ns(5 * kMillisecond);
  event.mutable_event()->set_message("armed");
  writer_.write(event);
  writer_.write(frame_at(3));
  close();
  auto messages = recording_->messages({.topics = {"/haptic/objects"}});
  ASSERT_TRUE(messages.next());
  EXPECT_EQ(messages.message().log_time, 5 * kMillisecond);
  EXPECT_EQ(messages.message().publish_time, 3 * kMillisecond);
}

TEST_F(SessionTest, EveryChannelCanBeReadByItsOwnSchema) {
  writer_.write(v1::SceneDescription(), 1);
  writer_.write(v1::DeviceList(), 1);
  writer_.write(v1::Gap(), 1);
  writer_.write(frame_at(1));
  close();
  std::size_t read = 0;
  for (auto messages = recording_->messages(); messages.next(); ++read) {
    const EmbeddedType type(recording_->schemas().at(messages.channel().schema_id));
    EXPECT_NO_THROW(type.parse(messages.message().data)) << messages.channel().topic;
    EXPECT_EQ(messages.channel().message_encoding, "protobuf");
  }
  EXPECT_EQ(read, recording_->statistics().message_count);
  EXPECT_GE(read, 9U);
}

TEST_F(SessionWithoutViewersTest, NothingIsDrawn) {
  writer_.write(v1::SceneDescription(), 1);
  writer_.write(frame_at(1));
  v1::Frame event;
  event.mutable_event()->set_message("armed");
  writer_.write(event);
  close();
  for (const auto& [id, channel] : recording_->channels()) {
    EXPECT_EQ(channel.topic.find("/foxglove"), std::string::npos) << channel.topic;
  }
}

}  // namespace
}  // namespace haptic::recording
