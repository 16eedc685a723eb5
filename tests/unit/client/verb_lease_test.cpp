// hapticctl lease, as a shell runs it.

#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/test_daemon.h"

namespace haptic::cli {
namespace {

using test::Finished;

class VerbLease : public testing::Test {
 protected:
  VerbLease() {
    ipc::ServerSettings settings;
    settings.drive.longest_silence = std::chrono::seconds(5);
    daemon_ = std::make_unique<test::TestDaemon>(settings);
  }

  std::string ctl(const std::string& arguments) const {
    return test::hapticctl() + " --socket " + daemon_->address() + " " + arguments;
  }
  Finished run(const std::string& arguments) const { return test::run_program(ctl(arguments)); }

  // who holds the lease, seen by another client
  v1::Status status() const {
    client::Options options;
    options.address = daemon_->address();
    client::Connection connection(options);
    v1::Request request;
    request.mutable_get_status();
    return connection.call(request).status();
  }

  std::unique_ptr<test::TestDaemon> daemon_;
};

TEST_F(VerbLease, HoldsItWhileACommandRunsAndExitsAsThatDoes) {
  const Finished shown = run("lease -- " + ctl("status") + " --json");
  EXPECT_EQ(shown.code, 0) << shown.output;
  EXPECT_NE(shown.output.find(", hapticctl: a heartbeat within 5000 ms"), std::string::npos) << shown.output;
  EXPECT_NE(shown.output.find(R"("drive_holder":{"client":")"), std::string::npos) << shown.output;
  EXPECT_FALSE(status().has_drive_holder());
  EXPECT_EQ(run("lease -- sh -c 'exit 7'").code, 7);
  EXPECT_EQ(run("lease -- sh -c 'kill -9 $$'").code, 128 + 9);
}

TEST_F(VerbLease, TellsACommandThatCannotRun) {
  const Finished missing = run("lease -- /nowhere/program");
  EXPECT_EQ(missing.code, 127);
  EXPECT_NE(missing.output.find("hapticctl: cannot run /nowhere/program: No such file"), std::string::npos);
  EXPECT_EQ(run("lease -- /").code, 126);
  EXPECT_FALSE(status().has_drive_holder());
}

TEST_F(VerbLease, KeepsOthersFromArmingMeanwhile) {
  const Finished refused = run("lease -- " + ctl("arm"));
  EXPECT_EQ(refused.code, 4);
  EXPECT_NE(refused.output.find("holds the drive lease; only its holder can arm"), std::string::npos)
      << refused.output;
  EXPECT_EQ(run("lease -- " + ctl("lease --seconds 1")).code, 4);
  EXPECT_EQ(run("arm").code, 0);
}

TEST_F(VerbLease, ArmsAndDisarmsIfItIsTold) {
  EXPECT_EQ(run("lease --arm -- true").code, 0);
  EXPECT_EQ(daemon_->servo().seen(), (std::vector{servo::CommandKind::kArm, servo::CommandKind::kDisarm}));
}

TEST_F(VerbLease, IsGivenBackWhenAFaultKeepsItFromArming) {
  daemon_->servo().latch({.kind = safety::FaultKind::kOverSpeed, .device = 0, .value = 3, .limit = 2});
  EXPECT_EQ(run("lease --arm -- true").code, 7);
  EXPECT_FALSE(status().has_drive_holder());
}

TEST_F(VerbLease, EndsAfterItsSeconds) {
  EXPECT_EQ(run("lease --seconds 0.1").code, 0);
  EXPECT_FALSE(status().has_drive_holder());
}

TEST_F(VerbLease, IsGivenBackOnASignal) {
  const Finished ended = test::run_program("timeout --signal=INT --preserve-status 1 " + ctl("lease --arm"));
  EXPECT_EQ(ended.code, 0) << ended.output;
  EXPECT_EQ(daemon_->servo().seen(), (std::vector{servo::CommandKind::kArm, servo::CommandKind::kDisarm}));
  EXPECT_FALSE(status().has_drive_holder());
}

TEST_F(VerbLease, IsLostWithAFaultWhenItDies) {
  EXPECT_NE(test::run_program("timeout --signal=KILL 1 " + ctl("lease --arm")).code, 0);
  EXPECT_EQ(run("arm").code, 7);
}

TEST_F(VerbLease, EndsItsCommandWhenTheDaemonIsGone) {
  const std::string begun = daemon_->folder().file("begun");
  Finished ended;
  std::thread program([&] { ended = run("lease -- sh -c 'touch " + begun + "; exec sleep 60'"); });
  while (!std::filesystem::exists(begun)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  daemon_->stop();
  program.join();
  EXPECT_EQ(ended.code, 5);
  EXPECT_NE(ended.output.find("hapticctl: hapticd stops"), std::string::npos) << ended.output;
}

TEST_F(VerbLease, AsksForAHeartbeatThatTheConfigPermits) {
  const Finished refused = run("lease --heartbeat 6000 --seconds 1");
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.output.find("acquire_drive.heartbeat_ms: 6000 ms are not permitted"), std::string::npos);
  EXPECT_NE(run("lease --heartbeat 700 --seconds 0.1").output.find("within 700 ms"), std::string::npos);
}

}  // namespace
}  // namespace haptic::cli
