#include "ipc/encode.h"

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <limits>

#include "proto/framing.h"
#include "proto/protocol.h"

namespace haptic::ipc {
namespace {

servo::Snapshot example_snapshot() {
  servo::Snapshot snapshot;
  snapshot.tick = 300;
  snapshot.monotonic_ns = 5'000;
  snapshot.scene_revision = 4;
  snapshot.armed = true;
  snapshot.objects.push_back({.position = {1, 2, 3},
                              .orientation = {0.5, 0.5, 0.5, -0.5},
                              .velocity = {4, 5, 6},
                              .angular_velocity = {7, 8, 9},
                              .force = {10, 11, 12},
                              .torque = {13, 14, 15}});
  snapshot.hips.push_back({.position = {0.1, 0.2, 0.3}, .force = {0, 0, 1}});
  snapshot.hips.push_back({.position = {0.4, 0.5, 0.6}, .force = {0, 0, 2}});
  snapshot.contacts.push_back({.hip = 1,
                               .object = 0,
                               .state = engine::ConstraintState::kEdg,
                               .slipping = true,
                               .proxy = {0.4, 0.5, 0.7},
                               .force = {0, 0, 2}});
  return snapshot;
}

TEST(EncodeFrame, PacksEachTopicInTheOrderOfTheSchema) {
  v1::Frame frame;
  fill_frame(example_snapshot(), topic_bit(v1::OBJECTS) | topic_bit(v1::HIPS), 1000, frame);
  EXPECT_EQ(frame.tick(), 300U);
  EXPECT_EQ(frame.realtime_ns(), 6'000U);  // monotonic + offset
  EXPECT_EQ(frame.scene_revision(), 4U);
  EXPECT_TRUE(frame.armed());
  ASSERT_EQ(frame.objects().orientation_size(), 4);
  EXPECT_EQ(frame.objects().orientation(0), 0.5);   // w
  EXPECT_EQ(frame.objects().orientation(3), -0.5);  // z
  EXPECT_EQ(frame.objects().torque(2), 15.0);
  ASSERT_EQ(frame.hips().position_size(), 6);
  EXPECT_EQ(frame.hips().position(3), 0.4);
  ASSERT_EQ(frame.hips().contact_hip_size(), 1);
  EXPECT_EQ(frame.hips().contact_hip(0), 1U);
  EXPECT_EQ(frame.hips().contact_state(0), v1::EDG);
  EXPECT_TRUE(frame.hips().contact_slipping(0));
  EXPECT_EQ(frame.hips().contact_proxy(2), 0.7);
  EXPECT_FALSE(frame.has_devices());
}

TEST(EncodeFrame, WithItsHeadIsTheEnvelopeThatProtobufWouldWrite) {
  v1::Frame frame;
  fill_frame(example_snapshot(), topic_bit(v1::OBJECTS) | topic_bit(v1::DEVICES), 0, frame);
  const std::string body = frame.SerializeAsString();
  for (const std::uint64_t sequence : {std::uint64_t{1}, std::uint64_t{127}, std::uint64_t{128},
                                       std::numeric_limits<std::uint64_t>::max()}) {
    std::string bytes;
    append_frame_head(sequence, 300, body.size(), bytes);
    v1::Envelope whole;
    *whole.mutable_frame() = frame;
    whole.mutable_frame()->set_sequence(sequence);
    whole.mutable_frame()->set_subscription(300);
    std::string expected;
    proto::append_frame(whole, expected);
    EXPECT_EQ(bytes + body, expected) << sequence;
  }
}

}  // namespace
}  // namespace haptic::ipc
