#include "ipc/encode.h"

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <limits>

#include "ipc/convert.h"
#include "proto/framing.h"
#include "proto/protocol.h"
#include "safety/limits.h"

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
  fill_frame(example_snapshot(), topic_bit(v1::OBJECTS) | topic_bit(v1::HIPS), {}, 1000, frame);
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

TEST(EncodeFrame, TellsWhatATickFollowsFrom) {
  servo::Snapshot snapshot = example_snapshot();
  snapshot.devices.push_back({.present = true,
                              .position = {1, 2, 3},
                              .orientation = {0.5, 0.5, 0.5, -0.5},
                              .velocity = {4, 5, 6},
                              .force = {},
                              .torque = {},
                              .sample_age = 0.0,
                              .buttons = 0,
                              .limits = 0,
                              .fault = {}});
  snapshot.inputs.missed = 2;
  snapshot.inputs.commands[0] = {.kind = servo::CommandKind::kStep, .ticks = 8};
  snapshot.inputs.commands[1] = {.kind = servo::CommandKind::kSwapScene, .revision = 5};
  snapshot.inputs.command_count = 2;
  snapshot.inputs.state_hash = 0x123456789abcdef0;
  v1::Frame frame;
  fill_frame(snapshot, topic_bit(v1::INPUTS), {}, 0, frame);
  const v1::InputsFrame& inputs = frame.inputs();
  ASSERT_EQ(inputs.orientation_size(), 4);
  EXPECT_EQ(inputs.position(2), 3.0);
  EXPECT_EQ(inputs.orientation(3), -0.5);
  EXPECT_EQ(inputs.velocity(0), 4.0);
  EXPECT_TRUE(inputs.present(0));
  EXPECT_EQ(inputs.missed(), 2U);
  ASSERT_EQ(inputs.command_size(), 2);
  EXPECT_EQ(inputs.command(0).kind(), v1::InputsFrame::STEP);
  EXPECT_EQ(inputs.command(0).ticks(), 8U);
  EXPECT_EQ(inputs.command(1).kind(), v1::InputsFrame::SCENE);
  EXPECT_EQ(inputs.command(1).scene_revision(), 5U);
  EXPECT_EQ(inputs.state_hash(), 0x123456789abcdef0U);
}

TEST(EncodeFrame, TellsWhatTheGuardDoesToADevice) {
  servo::Snapshot snapshot;
  servo::DeviceSnapshot device{};
  device.limits = safety::kLimitRate | safety::kLimitClutch;
  device.acceleration = {1, 2, 3};
  device.energy = -0.25;
  device.fault.kind = safety::FaultKind::kOverTravel;
  snapshot.devices = {device};
  v1::Frame frame;
  fill_frame(snapshot, topic_bit(v1::DEVICES), {}, 0, frame);
  const v1::DevicesFrame& devices = frame.devices();
  EXPECT_EQ(devices.limits(0), 1U << v1::LIMIT_RATE | 1U << v1::LIMIT_CLUTCH);
  ASSERT_EQ(devices.acceleration_size(), 3);
  EXPECT_EQ(devices.acceleration(2), 3.0);
  EXPECT_EQ(devices.energy(0), -0.25);
  EXPECT_EQ(devices.fault(0), v1::FAULT_OVER_TRAVEL);
}

TEST(EncodeFrame, FaultsAreToldInWordsWithTheirUnit) {
  const auto told = [](safety::FaultKind kind, double value, double limit) {
    return in_words(to_wire({.kind = kind, .value = value, .limit = limit}, {}));
  };
  EXPECT_EQ(told(safety::FaultKind::kOverTravel, -0.115, -0.1),
            "over travel, -0.115 m where -0.1 m is allowed");
  EXPECT_EQ(told(safety::FaultKind::kOverTravel, 0.02, 0.0), "over travel, 0.02 m where 0 m is allowed");
  EXPECT_EQ(told(safety::FaultKind::kEnergy, 1.25, 1.0),
            "too much energy given to the user, 1.25 J where 1 J is allowed");
  EXPECT_EQ(told(safety::FaultKind::kStillSample, 0.6, 0.5),
            "the same position all the time, 0.6 s where 0.5 s is allowed");
  EXPECT_EQ(told(safety::FaultKind::kEmergencyStop, 0.0, 0.0), "emergency stop");
}

TEST(EncodeFrame, WithItsHeadIsTheEnvelopeThatProtobufWouldWrite) {
  v1::Frame frame;
  fill_frame(example_snapshot(), topic_bit(v1::OBJECTS) | topic_bit(v1::DEVICES), {}, 0, frame);
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

TEST(EncodeFrame, BatchesAreTheEnvelopeThatProtobufWouldWrite) {
  v1::Frame frame;
  fill_frame(example_snapshot(), topic_bit(v1::HIPS), {}, 0, frame);
  const std::string body = frame.SerializeAsString();
  v1::Envelope whole;
  std::vector<FrameHead> frames;
  for (const std::uint64_t sequence : {std::uint64_t{127}, std::uint64_t{128}, std::uint64_t{129}}) {
    v1::Frame& next = *whole.mutable_batch()->add_frame();
    next = frame;
    next.set_sequence(sequence);
    next.set_subscription(3);
    frames.push_back({sequence, 3, body.size()});
  }
  std::string expected;
  proto::append_frame(whole, expected);
  std::string bytes;
  for (const std::string& head : batch_heads(frames)) {
    bytes += head + body;
  }
  EXPECT_EQ(bytes, expected);
}

// fingers "a" with HIPs 0 and 1, "b" with HIP 2; objects "x" and "y"
v1::SceneDescription example_names() {
  v1::SceneDescription scene;
  scene.add_object()->set_name("x");
  scene.add_object()->set_name("y");
  auto& a = *scene.add_finger();
  a.set_name("a");
  a.set_hips(2);
  auto& b = *scene.add_finger();
  b.set_name("b");
  b.set_first_hip(2);
  b.set_hips(1);
  return scene;
}

// HIP 0 in free air of x, 1 pressed on y, 2 on the surface of x without force
servo::Snapshot touching() {
  servo::Snapshot snapshot;
  snapshot.objects.resize(2);
  snapshot.hips.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    snapshot.hips[i].position.x = static_cast<double>(i);
  }
  using engine::ConstraintState;
  snapshot.contacts.push_back({0, 0, ConstraintState::kTet, false, {}, {}});
  snapshot.contacts.push_back({1, 1, ConstraintState::kTet, false, {}, {0, 0, 1}});
  snapshot.contacts.push_back({2, 0, ConstraintState::kSur, false, {}, {}});
  return snapshot;
}

v1::HipsFrame hips_of(const Filter& filter) {
  v1::Frame frame;
  fill_frame(touching(), topic_bit(v1::HIPS), select(filter, example_names()), 0, frame);
  EXPECT_EQ(frame.hips().position_size(), frame.hips().force_size());
  return frame.hips();
}

using Indices = std::vector<std::uint32_t>;

template <class Array>
Indices list(const Array& array) {
  return {array.begin(), array.end()};
}

TEST(EncodeFrame, TellsHipsOfChosenFingersByNumber) {
  const v1::HipsFrame b = hips_of({.fingers = {"b"}, .objects = {}});
  EXPECT_EQ(list(b.hip()), Indices{2});
  ASSERT_EQ(b.position_size(), 3);
  EXPECT_EQ(b.position(0), 2.0);
  EXPECT_EQ(list(b.contact_hip()), Indices{2});
  EXPECT_EQ(hips_of({}).hip_size(), 0);  // all need no numbers
  EXPECT_EQ(hips_of({}).position_size(), 9);
}

TEST(EncodeFrame, TellsContactsWithChosenObjects) {
  const v1::HipsFrame x = hips_of({.fingers = {}, .objects = {"x"}});
  EXPECT_EQ(x.position_size(), 9);
  EXPECT_EQ(list(x.contact_hip()), (Indices{0, 2}));
}

TEST(EncodeFrame, TellsOnlyHipsInContact) {
  const v1::HipsFrame all = hips_of({.fingers = {}, .objects = {}, .only_in_contact = true});
  EXPECT_EQ(list(all.hip()), (Indices{1, 2}));
  EXPECT_EQ(list(all.contact_hip()), (Indices{1, 2}));
  const v1::HipsFrame x = hips_of({.fingers = {}, .objects = {"x"}, .only_in_contact = true});
  EXPECT_EQ(list(x.hip()), Indices{2});
  const v1::HipsFrame none = hips_of({.fingers = {"a"}, .objects = {"x"}, .only_in_contact = true});
  EXPECT_EQ(none.position_size(), 0);
}

TEST(EncodeFrame, StaysWithinASceneThatDoesNotFitTheSnapshot) {
  const Selection selection = select({.fingers = {"b"}, .objects = {"y"}}, example_names());
  servo::Snapshot snapshot = touching();
  snapshot.objects.resize(5);
  snapshot.hips.resize(9);
  snapshot.contacts.push_back({77, 88, engine::ConstraintState::kSur, false, {}, {}});
  v1::Frame frame;
  fill_frame(snapshot, kTickTopics, selection, 0, frame);
  EXPECT_EQ(list(frame.hips().hip()), Indices{2});
  EXPECT_EQ(list(frame.objects().object()), Indices{1});
}

}  // namespace
}  // namespace haptic::ipc
