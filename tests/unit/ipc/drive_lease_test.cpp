#include "ipc/drive_lease.h"

#include <gtest/gtest.h>

#include <memory>

namespace haptic::ipc {
namespace {

using std::chrono::milliseconds;

class Lease : public testing::Test {
 protected:
  void take(ClientId client) { lease_.acquire(client, {"user ada", "pilot"}, milliseconds(100), now_); }

  // two polls, as the io thread would make them: the first one only suspects
  void pass(milliseconds time) {
    now_ += time;
    lease_.poll(now_);
    now_ += milliseconds(2);
    lease_.poll(now_);
  }

  std::vector<servo::Command> commands() {
    std::vector<servo::Command> all;
    mailbox_->commands.consume_all([&](const servo::Command& command) { all.push_back(command); });
    return all;
  }

  std::unique_ptr<servo::Mailbox> mailbox_ = std::make_unique<servo::Mailbox>(servo::Capacity{1, 1, 1, 1, 1});
  ServoLink servo_{*mailbox_, std::chrono::seconds(1), [](const servo::Event&) {}};
  DriveLease lease_{DrivePolicy(), servo_};
  SteadyClock::time_point now_{std::chrono::hours(1)};
};

TEST_F(Lease, IsOneClientsAtATime) {
  EXPECT_FALSE(lease_.refusal(1));
  take(1);
  EXPECT_FALSE(lease_.refusal(1));
  EXPECT_EQ(lease_.refusal(2), "user ada holds the drive lease");
  EXPECT_FALSE(lease_.release(2));
  EXPECT_TRUE(lease_.release(1));
  EXPECT_FALSE(lease_.refusal(2));
}

TEST_F(Lease, LastsAsLongAsItsHeartbeat) {
  take(1);
  for (int i = 0; i < 20; ++i) {
    pass(milliseconds(90));
    EXPECT_TRUE(lease_.beat(1, now_));
  }
  EXPECT_TRUE(commands().empty());
  pass(milliseconds(101));
  EXPECT_FALSE(lease_.beat(1, now_));
  const auto told = commands();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, servo::CommandKind::kLatchFault);
  EXPECT_EQ(told[0].fault.kind, safety::FaultKind::kLostDriver);
  EXPECT_NEAR(told[0].fault.value, 0.103, 1e-9);  // 101 ms, and 2 to the poll that is sure
  EXPECT_NEAR(told[0].fault.limit, 0.1, 1e-9);
}

TEST_F(Lease, ForgivesABeatThatWaitedWhileThisThreadWasLate) {
  take(1);
  now_ += milliseconds(500);
  lease_.poll(now_);
  EXPECT_TRUE(lease_.beat(1, now_));
  now_ += milliseconds(2);
  lease_.poll(now_);
  EXPECT_TRUE(commands().empty());
}

TEST_F(Lease, IsLostWithTheConnectionOfItsHolderOnly) {
  take(1);
  lease_.forget(2, now_);
  EXPECT_TRUE(commands().empty());
  lease_.forget(1, now_);
  const auto told = commands();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, servo::CommandKind::kLatchFault);
  lease_.forget(1, now_);
  EXPECT_TRUE(commands().empty());
}

TEST_F(Lease, IsNotLostOnceItIsReleased) {
  take(1);
  lease_.release(1);
  lease_.forget(1, now_);
  pass(milliseconds(1000));
  EXPECT_TRUE(commands().empty());
}

TEST_F(Lease, DisarmsOrKeepsForcesIfTheConfigSaysSo) {
  DriveLease disarming({.on_loss = v1::Drive::DISARM}, servo_);
  disarming.acquire(1, {"ada", "pilot"}, milliseconds(100), now_);
  disarming.forget(1, now_);
  const auto told = commands();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, servo::CommandKind::kDisarm);

  DriveLease keeping({.on_loss = v1::Drive::KEEP}, servo_);
  keeping.acquire(1, {"ada", "pilot"}, milliseconds(100), now_);
  keeping.forget(1, now_);
  EXPECT_TRUE(commands().empty());
  EXPECT_FALSE(keeping.refusal(2));
}

TEST_F(Lease, TellsALossEvenIfTheServosQueueWasFullAndLetsNobodyArmBefore) {
  take(1);
  while (mailbox_->commands.push({})) {
  }
  lease_.forget(1, now_);
  EXPECT_TRUE(lease_.refusal(2));
  commands();
  lease_.poll(now_);
  const auto told = commands();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, servo::CommandKind::kLatchFault);
  EXPECT_FALSE(lease_.refusal(2));
}

}  // namespace
}  // namespace haptic::ipc
