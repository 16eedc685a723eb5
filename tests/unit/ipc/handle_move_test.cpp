#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ipc/dispatch.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using std::chrono::milliseconds;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(SteadyClock::now().time_since_epoch()).count();
}

// what handlers work with, and two devices: "arm", which is not to be moved, and "mouse"
class MoveDevice : public testing::Test {
 protected:
  MoveDevice() {
    services_.devices.resize(2);
    services_.devices[0].set_name("arm");
    services_.devices[0].set_driver("falcon");
    services_.devices[1].set_name("mouse");
    services_.devices[1].set_driver("virtual");
    services_.place_device = {PlaceDevice(), [this](const DevicePlace& place) {
                                placed_.push_back(place);
                                return live_;
                              }};
    move_.set_device("mouse");
    move_.mutable_pose()->mutable_position()->set_x(0.25);
  }

  v1::Response ask(ClientId client = 1, v1::Role role = v1::DRIVE) {
    v1::Request request;
    *request.mutable_move_device() = move_;
    std::optional<v1::Response> answer;
    Caller caller;
    caller.id = client;
    caller.role = role;
    caller.name = "user " + std::to_string(client);
    dispatch(desk_, caller, request,
             Reply(7, [&](v1::Response&& response) { answer = std::move(response); }));
    return answer.value_or(v1::Response());
  }

  v1::Error::Code code(ClientId client = 1) { return ask(client).error().code(); }

  std::string wrong_field() {
    const v1::Error error = ask().error();
    EXPECT_EQ(error.code(), v1::Error::INVALID) << error.message();
    EXPECT_TRUE(placed_.empty());
    return error.field();
  }

  std::unique_ptr<servo::Mailbox> mailbox_ = std::make_unique<servo::Mailbox>(servo::Capacity{4, 4, 4, 4, 4});
  Services services_{.mailbox = *mailbox_,
                     .version = "1.2",
                     .rate_hz = 1000.0,
                     .devices = {},
                     .real_time = {},
                     .scene = test::example_scene(),
                     .running = {},
                     .build_scene = test::build_example,
                     .edit_scene = test::edit_example};
  ServoLink servo_{*mailbox_, std::chrono::seconds(1), [](const servo::Event&) {}};
  SceneStore scenes_{services_, servo_};
  Publisher publisher_;
  DriveLease lease_{DrivePolicy(), servo_};
  Desk desk_{services_, servo_, scenes_, publisher_, SteadyClock::now(), [] { return std::size_t{1}; },
             lease_};

  v1::MoveDevice move_;
  std::vector<DevicePlace> placed_;
  LiveForce live_;
};

TEST_F(MoveDevice, PlacesTheDeviceAndReturnsItsForce) {
  move_.mutable_pose()->mutable_orientation()->set_y(2.0);
  move_.mutable_velocity()->set_z(-0.5);
  move_.set_buttons(5);
  live_ = {.expires_ns = now_ns() + 3'000'000'000, .force = {1.0, 2.0, 3.0}, .torque = {4.0, 5.0, 6.0}};
  const std::int64_t before = now_ns();
  const v1::Response response = ask();
  ASSERT_EQ(placed_.size(), 1U);
  EXPECT_EQ(placed_[0].position, glm::dvec3(0.25, 0.0, 0.0));
  EXPECT_EQ(placed_[0].orientation, glm::dquat(0.0, 0.0, 1.0, 0.0)) << "normalised";
  EXPECT_EQ(placed_[0].velocity, glm::dvec3(0.0, 0.0, -0.5));
  EXPECT_EQ(placed_[0].buttons, 5U);
  EXPECT_GE(placed_[0].time_ns, before);
  EXPECT_LE(placed_[0].time_ns, now_ns());
  const v1::DeviceForce& force = response.device_force();
  EXPECT_EQ(force.wrench().force().y(), 2.0);
  EXPECT_EQ(force.wrench().torque().z(), 6.0);
  EXPECT_EQ(force.expires_ns(), static_cast<std::uint64_t>(live_.expires_ns));
  EXPECT_GT(force.lifetime(), 0.0);
  EXPECT_LE(force.lifetime(), 3.0);
}

TEST_F(MoveDevice, WhatIsLeftAwayIsNoRotationAndAVelocityThatIsNotTold) {
  ask();
  ASSERT_EQ(placed_.size(), 1U);
  EXPECT_EQ(placed_[0].orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_FALSE(placed_[0].velocity);
}

TEST_F(MoveDevice, ADeadForceHasNoLifetime) {
  EXPECT_EQ(ask().device_force().expires_ns(), 0U);
  EXPECT_EQ(ask().device_force().lifetime(), 0.0);
}

TEST_F(MoveDevice, NeedsTheRoleOfWhoeverDrives) {
  for (const v1::Role role : {v1::OBSERVE, v1::SCRIPT}) {
    EXPECT_EQ(ask(1, role).error().code(), v1::Error::REFUSED);
  }
  EXPECT_TRUE(placed_.empty());
  EXPECT_FALSE(ask(1, v1::DRIVE).has_error());
}

TEST_F(MoveDevice, IsForTheHolderOfTheLeaseWhileThereIsOne) {
  lease_.acquire(2, {"user 2", "pilot"}, milliseconds(100), SteadyClock::now());
  const v1::Error error = ask(1).error();
  EXPECT_EQ(error.code(), v1::Error::REFUSED);
  EXPECT_EQ(error.message(), "user 2 holds the drive lease; only its holder can move devices");
  EXPECT_FALSE(ask(2).has_error());
}

TEST_F(MoveDevice, NamesADeviceThatIsNotThereOrIsNotToBeMoved) {
  move_.set_device("foot");
  EXPECT_EQ(ask().error().code(), v1::Error::NOT_FOUND);
  EXPECT_EQ(ask().error().field(), "move_device.device");
  move_.set_device("arm");
  EXPECT_EQ(wrong_field(), "move_device.device");
  EXPECT_NE(ask().error().message().find("driver falcon"), std::string::npos);
}

TEST_F(MoveDevice, RefusesNumbersThatAreNoneOrTooLargeByTheirField) {
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity(), 1.1e6}) {
    const v1::MoveDevice good = move_;
    move_.mutable_pose()->mutable_position()->set_y(wrong);
    EXPECT_EQ(wrong_field(), "move_device.pose.position.y");
    move_ = good;
    move_.mutable_velocity()->set_z(wrong);
    EXPECT_EQ(wrong_field(), "move_device.velocity.z");
    move_ = good;
    move_.mutable_pose()->mutable_orientation()->set_x(wrong);
    EXPECT_EQ(wrong_field(), "move_device.pose.orientation");
    move_ = good;
  }
  move_.mutable_pose()->mutable_orientation()->set_x(1e-9);
  EXPECT_EQ(wrong_field(), "move_device.pose.orientation");
}

TEST_F(MoveDevice, ASampleFromTheFutureIsRefusedAsItWouldNeverGrowOld) {
  move_.set_monotonic_ns(static_cast<std::uint64_t>(now_ns()) + 3'600'000'000'000U);
  EXPECT_EQ(wrong_field(), "move_device.monotonic_ns");
  move_.set_monotonic_ns(std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(wrong_field(), "move_device.monotonic_ns");
  const std::int64_t measured = now_ns() - 5'000'000;
  move_.set_monotonic_ns(static_cast<std::uint64_t>(measured));
  EXPECT_FALSE(ask().has_error());
  EXPECT_EQ(placed_.at(0).time_ns, measured);
}

TEST_F(MoveDevice, TakesNoSampleAfterANewerOne) {
  move_.set_sequence(5);
  EXPECT_FALSE(ask().has_error());
  EXPECT_EQ(code(), v1::Error::NOTHING_TO_DO) << "the same again";
  move_.set_sequence(4);
  EXPECT_EQ(code(), v1::Error::NOTHING_TO_DO);
  move_.set_sequence(6);
  EXPECT_FALSE(ask().has_error());
  move_.set_sequence(0);
  EXPECT_FALSE(ask().has_error()) << "not counted";
  move_.set_sequence(6);
  EXPECT_EQ(code(), v1::Error::NOTHING_TO_DO) << "counting goes on";
  move_.set_sequence(0);
  move_.set_monotonic_ns(static_cast<std::uint64_t>(now_ns()) - 1'000'000'000U);
  EXPECT_EQ(code(), v1::Error::NOTHING_TO_DO) << "measured before";
  EXPECT_EQ(placed_.size(), 3U);
}

TEST_F(MoveDevice, IsForOneClientAtATime) {
  EXPECT_FALSE(ask(1).has_error());
  const v1::Error error = ask(2).error();
  EXPECT_EQ(error.code(), v1::Error::REFUSED);
  EXPECT_EQ(error.message(), "user 1 moves this device");
  // whoever takes the lease need not wait
  lease_.acquire(2, {"user 2", "pilot"}, milliseconds(100), SteadyClock::now());
  EXPECT_FALSE(ask(2).has_error());
}

TEST(DeviceMoves, AnotherClientMayMoveItOnceTheFormerOneHasFallenSilent) {
  const SteadyClock::time_point start{std::chrono::hours(1)};
  DeviceMoves moves;
  EXPECT_FALSE(moves.refusal(0, 2, start));
  moves.take(0, {.client = 1, .name = "ada", .sequence = 9, .time_ns = 1000, .arrived = start});
  EXPECT_FALSE(moves.refusal(0, 1, start));
  EXPECT_FALSE(moves.refusal(1, 2, start)) << "the other device";
  EXPECT_EQ(moves.refusal(0, 2, start + kMoverSilence), "ada moves this device");
  EXPECT_FALSE(moves.refusal(0, 2, start + kMoverSilence + milliseconds(1)));
  // another client counts for itself, and time goes on for all
  EXPECT_FALSE(moves.is_old(0, 2, 1, 1000));
  EXPECT_TRUE(moves.is_old(0, 2, 1, 999));
}

}  // namespace
}  // namespace haptic::ipc
