#include "servo/servo_thread.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using namespace std::chrono_literals;

/// Waits until `happened()`, for seconds if need be: machines that run tests are busy.
template <class Predicate>
bool wait_until(Predicate&& happened) {
  for (int i = 0; i < 20000; ++i) {
    if (happened()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

TEST(ServoThread, TicksUntilItIsStopped) {
  test::ServoRig rig({.limits = test::wide_limits()});
  ServoThread thread({.priority = 10}, 1000.0, rig.loop());
  ASSERT_TRUE(wait_until([&] { return thread.heartbeat() > 50; }));
  thread.stop();
  const std::uint64_t last = thread.heartbeat();
  thread.stop();
  EXPECT_EQ(thread.heartbeat(), last);
  EXPECT_EQ(rig.snapshot().tick, last - 1 + rig.snapshot().missed_ticks);
}

TEST(ServoThread, ServesCommandsAndSnapshotsFromAnotherThread) {
  test::ServoRig rig({.limits = test::wide_limits(), .max_missed_ticks = 1000000});
  ServoThread thread({.priority = 10}, 1000.0, rig.loop());
  std::uint64_t answers = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t retired = 0;
  for (std::uint64_t revision = 2; revision < 12; ++revision) {
    rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .scene = rig.prepare(revision).release()});
    ASSERT_TRUE(wait_until([&] {
      for (const Event& event : rig.events()) {
        if (event.kind == EventKind::kDone) ++answers;
        if (event.kind == EventKind::kSceneRetired) ++retired;
        delete event.scene;
      }
      return answers == revision - 1;
    }));
    while (rig.mailbox().snapshots.take() != nullptr) ++snapshots;
  }
  thread.stop();
  EXPECT_EQ(retired, 10u);
  EXPECT_GT(snapshots, 0u);
}

TEST(ServoThread, StoppingBringsForcesDownByTheSlewLimitFirst) {
  safety::GuardLimits limits = test::wide_limits();
  limits.max_force_rate = 20.0;  // 1 N in 50 ticks
  limits.max_sample_age = 1e6;   // the machine may sleep
  test::ServoRig rig({.limits = limits, .max_missed_ticks = 1000000, .armed_from_start = true});
  rig.device(0).sample.position = {0.01, 0.02, 0.005};
  rig.tick();
  rig.device(0).sample.position.z = -0.01;
  rig.tick(60);
  ASSERT_NEAR(rig.device(0).written.force.z, 1.0, 1e-9);

  ServoThread thread({.priority = 10}, 1000.0, rig.loop());
  ASSERT_TRUE(wait_until([&] { return thread.heartbeat() > 5; }));
  thread.stop();
  EXPECT_EQ(rig.device(0).written.force, glm::dvec3(0.0));
  double last = 1.0;
  while (const Snapshot* snapshot = rig.mailbox().snapshots.take()) {
    EXPECT_LE(last - snapshot->devices[0].force.z, 0.02 + 1e-9);
    last = snapshot->devices[0].force.z;
  }
  EXPECT_EQ(last, 0.0);
}

TEST(ServoThread, EndsEvenIfForcesCannotGoDownInTime) {
  safety::GuardLimits limits = test::wide_limits();
  limits.max_force_rate = 0.5;  // 1 N would take 2 s
  limits.max_sample_age = 1e6;
  test::ServoRig rig({.limits = limits, .max_missed_ticks = 1000000, .armed_from_start = true});
  rig.device(0).sample.position = {0.01, 0.02, 0.005};
  rig.tick();
  rig.device(0).sample.position.z = -0.01;
  rig.tick(2000);
  ServoThread thread({.priority = 10}, 1000.0, rig.loop());
  ASSERT_TRUE(wait_until([&] { return thread.heartbeat() > 5; }));
  const std::uint64_t before = thread.heartbeat();
  thread.stop();
  EXPECT_LE(thread.heartbeat() - before, 150u);
}

}  // namespace
}  // namespace haptic::servo
