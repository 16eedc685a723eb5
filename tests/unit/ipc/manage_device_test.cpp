#include <gtest/gtest.h>

#include <functional>

#include "ipc/dispatch.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using drivers::DeviceAction;
using drivers::DevicePhase;
using std::chrono::milliseconds;

// what handlers work with, and one device, "right", that can be identified and opened again
class ManageDevice : public testing::Test {
 protected:
  ManageDevice() {
    services_.devices.resize(1);
    services_.devices[0].set_name("right");
    services_.devices[0].set_driver("falcon");
    manage_.set_device("right");
    manage_.set_action(v1::ManageDevice::IDENTIFY);
    look();
  }

  /// The newest tick, as the io thread has seen it.
  void look(const std::function<void(servo::DeviceSnapshot&)>& change = {}) {
    servo::Snapshot snapshot;
    snapshot.tick = ++tick_;
    servo::DeviceSnapshot device{};
    device.present = true;
    if (change) {
      change(device);
    }
    snapshot.devices = {device};
    publisher_.publish(snapshot);
  }

  v1::Response send(const v1::Request& request, v1::Role role = v1::DRIVE, ClientId client = 1) {
    std::optional<v1::Response> answer;
    Caller caller;
    caller.id = client;
    caller.role = role;
    caller.name = "user " + std::to_string(client);
    dispatch(desk_, caller, request,
             Reply(7, [&](v1::Response&& response) { answer = std::move(response); }));
    return answer.value_or(v1::Response());
  }
  v1::Response ask(v1::Role role = v1::DRIVE, ClientId client = 1) {
    v1::Request request;
    *request.mutable_manage_device() = manage_;
    return send(request, role, client);
  }
  v1::DeviceStatus status() {
    v1::Request request;
    request.mutable_list_devices();
    return send(request, v1::OBSERVE).devices().device(0);
  }

  drivers::DeviceState state_{.phase = DevicePhase::kReady};
  drivers::DeviceWords words_;
  std::vector<DeviceAction> asked_;
  std::uint64_t tick_ = 0;
  std::unique_ptr<servo::Mailbox> mailbox_ = std::make_unique<servo::Mailbox>(servo::Capacity{4, 4, 4, 4, 4});
  Services services_{.mailbox = *mailbox_,
                     .version = "1.2",
                     .rate_hz = 1000.0,
                     .devices = {},
                     .real_time = {},
                     .scene = test::example_scene(),
                     .running = {},
                     .build_scene = test::build_example,
                     .edit_scene = test::edit_example,
                     .keepers = {{.state = [this] { return state_; },
                                  .words = [this] { return words_; },
                                  .knows =
                                      [](DeviceAction action) {
                                        return action == DeviceAction::kIdentify ||
                                               action == DeviceAction::kReopen;
                                      },
                                  .request = [this](DeviceAction action) { asked_.push_back(action); }}}};
  ServoLink servo_{*mailbox_, milliseconds(100), [](const servo::Event&) {}};
  SceneStore scenes_{services_, servo_};
  Publisher publisher_;
  DriveLease lease_{DrivePolicy(), servo_};
  Desk desk_{services_, servo_, scenes_, publisher_, SteadyClock::now(), [] { return std::size_t{1}; },
             lease_};
  v1::ManageDevice manage_;
};

TEST_F(ManageDevice, AsksTheDeviceForWhatItKnows) {
  EXPECT_TRUE(ask().has_done());
  manage_.set_action(v1::ManageDevice::REOPEN);
  EXPECT_TRUE(ask().has_done());
  EXPECT_EQ(asked_, (std::vector{DeviceAction::kIdentify, DeviceAction::kReopen}));
}

TEST_F(ManageDevice, WhatItsDriverDoesNotKnowIsUnsupported) {
  for (const auto action : {v1::ManageDevice::HOME, v1::ManageDevice::CALIBRATE}) {
    manage_.set_action(action);
    EXPECT_EQ(ask().error().code(), v1::Error::UNSUPPORTED);
  }
  EXPECT_EQ(ask().error().message(), "the driver falcon of \"right\" does not know how to calibrate");
  services_.keepers.clear();
  manage_.set_action(v1::ManageDevice::REOPEN);
  EXPECT_EQ(ask().error().code(), v1::Error::UNSUPPORTED) << "a computed device";
  EXPECT_TRUE(asked_.empty());
}

TEST_F(ManageDevice, IsForThoseWhoMayDrive) {
  EXPECT_EQ(ask(v1::SCRIPT).error().code(), v1::Error::REFUSED);
  lease_.acquire(2, {.name = "user 2", .program = "p"}, milliseconds(50), SteadyClock::now());
  EXPECT_EQ(ask(v1::ADMIN, 1).error().code(), v1::Error::REFUSED) << "while another drives";
  EXPECT_TRUE(ask(v1::DRIVE, 2).has_done());
}

TEST_F(ManageDevice, IsRefusedWhileTheDeviceIsArmed) {
  look([](servo::DeviceSnapshot& device) { device.armed = true; });
  manage_.set_action(v1::ManageDevice::REOPEN);
  EXPECT_EQ(ask().error().code(), v1::Error::REFUSED);
  EXPECT_EQ(ask().error().message(), "\"right\" is armed; disarm it first");
  EXPECT_TRUE(asked_.empty());
  look();
  EXPECT_TRUE(ask().has_done());
}

TEST_F(ManageDevice, OnlyOpeningItMakesSenseWhileItIsNotOpen) {
  state_.phase = DevicePhase::kFound;
  words_.reason = "no permission";
  EXPECT_EQ(ask().error().code(), v1::Error::FAILED);
  EXPECT_EQ(ask().error().message(), "\"right\" is not open: no permission");
  manage_.set_action(v1::ManageDevice::REOPEN);
  EXPECT_TRUE(ask().has_done());
}

TEST_F(ManageDevice, TellsTheFieldThatIsWrong) {
  manage_.set_device("left");
  EXPECT_EQ(ask().error().code(), v1::Error::NOT_FOUND);
  EXPECT_EQ(ask().error().field(), "manage_device.device");
  manage_.set_device("right");
  manage_.set_action(v1::ManageDevice::ACTION_UNSPECIFIED);
  EXPECT_EQ(ask().error().code(), v1::Error::INVALID);
  EXPECT_EQ(ask().error().field(), "manage_device.action");
}

TEST_F(ManageDevice, TheStatusTellsPhaseReasonSerialAndLosses) {
  state_ = {.phase = DevicePhase::kHoming, .losses = 3};
  words_ = {.reason = "pull its grip", .serial = "FT1"};
  look([](servo::DeviceSnapshot& device) { device.phase = DevicePhase::kHoming; });
  EXPECT_EQ(status().phase(), v1::DEVICE_HOMING);
  EXPECT_EQ(status().reason(), "pull its grip");
  EXPECT_EQ(status().serial(), "FT1");
  EXPECT_EQ(status().losses(), 3U);
}

TEST_F(ManageDevice, AReadyDeviceIsArmedOrFaultyOrWithoutSamples) {
  words_.reason = "";
  EXPECT_EQ(status().phase(), v1::DEVICE_READY);
  EXPECT_EQ(status().reason(), "");
  look([](servo::DeviceSnapshot& device) { device.armed = true; });
  EXPECT_EQ(status().phase(), v1::DEVICE_ARMED);
  look([](servo::DeviceSnapshot& device) { device.fault.kind = safety::FaultKind::kOverSpeed; });
  EXPECT_EQ(status().phase(), v1::DEVICE_FAULT);
  look([](servo::DeviceSnapshot& device) { device.present = false; });
  EXPECT_EQ(status().phase(), v1::DEVICE_ABSENT);
  EXPECT_EQ(status().reason(), "no sample comes from it");
}

TEST_F(ManageDevice, AFaultOfADeviceThatIsGoneDoesNotHideThatItIsGone) {
  look([](servo::DeviceSnapshot& device) {
    device.phase = DevicePhase::kAbsent;
    device.fault.kind = safety::FaultKind::kLostDevice;
  });
  EXPECT_EQ(status().phase(), v1::DEVICE_ABSENT);
  EXPECT_EQ(status().fault().kind(), v1::FAULT_LOST_DEVICE);
}

}  // namespace
}  // namespace haptic::ipc
