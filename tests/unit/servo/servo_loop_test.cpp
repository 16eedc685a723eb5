#include "servo/servo_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rt/allocation_guard.h"
#include "tests/support/expect_vector.h"
#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using test::kWallStiffness;
using test::ServoRig;

constexpr double kRounding = 1e-9;
constexpr glm::dvec3 kNothing{0.0};

ServoSettings armed_settings() { return {.limits = test::wide_limits(), .armed_from_start = true}; }

/// Both devices start in air, and the first then presses 10 mm into the wall: 1 N.
void press(ServoRig& rig, std::size_t device = 0) {
  rig.device(device).sample.position = {0.01, 0.02, 0.005};
  rig.tick();
  rig.device(device).sample.position.z = -0.01;
  rig.tick();
}

TEST(ServoLoop, GivesADeviceTheForceOfTheFingerThatRidesOnIt) {
  ServoRig rig(armed_settings());
  press(rig);
  EXPECT_TRUE(test::near(rig.device(0).written.force, {0.0, 0.0, kWallStiffness * 0.01}, kRounding));
  EXPECT_EQ(rig.device(1).written.force, kNothing);
}

TEST(ServoLoop, SumsTheFingersOfOneDevice) {
  const std::vector<std::string> names = {"a"};
  ServoRig rig(armed_settings(), names);
  auto scene = servo::prepare_scene(test::wall_scene({"a", "a", "elsewhere"}), 2, names);
  EXPECT_EQ(scene->device_of_finger, (std::vector<std::uint32_t>{0, 0, safety::kNoDevice}));
  rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .scene = scene.release()});
  press(rig);
  EXPECT_TRUE(test::near(rig.device(0).written.force, {0.0, 0.0, 2.0 * kWallStiffness * 0.01}, kRounding));
  for (const Event& event : rig.events()) delete event.scene;
}

TEST(ServoLoop, AForceExpiresAfterThreeMillisecondsOrThreePeriods) {
  for (const double rate : {100.0, 1000.0, 8000.0}) {
    ServoSettings settings = armed_settings();
    settings.rate_hz = rate;
    ServoRig rig(settings);
    rig.tick(5);
    const auto lifetime = static_cast<double>(rig.device(0).written.expires - rig.device(0).written_at);
    EXPECT_NEAR(lifetime, std::max(3e6, 3e9 / rate), 1.0);
  }
}

TEST(ServoLoop, LimitsForceToWhatTheDeviceBears) {
  // the device of the rig bears 1e9 N; the limit of the settings is smaller
  ServoSettings settings = armed_settings();
  settings.limits.max_force = 0.25;
  ServoRig rig(settings);
  press(rig);
  EXPECT_TRUE(test::near(rig.device(0).written.force, {0.0, 0.0, 0.25}, kRounding));
}

TEST(ServoLoop, AFaultOfOneDeviceCutsAllOfThemInTheSameTick) {
  for (const std::size_t culprit : {0u, 1u}) {
    ServoRig rig(armed_settings());
    press(rig, 0);
    press(rig, 1);
    ASSERT_GT(rig.device(0).written.force.z, 0.5);
    rig.events();
    rig.device(culprit).sample.velocity = {3.0, 0.0, 0.0};
    rig.tick();
    EXPECT_EQ(rig.device(0).written.force, kNothing);
    EXPECT_EQ(rig.device(1).written.force, kNothing);

    const std::vector<Event> events = rig.events();
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, EventKind::kFaultLatched);
    EXPECT_EQ(events[0].fault.kind, safety::FaultKind::kOverSpeed);
    EXPECT_EQ(events[0].fault.device, culprit);
    EXPECT_EQ(events[0].fault.value, 3.0);

    // it stays so when the reason is gone
    rig.device(culprit).sample.velocity = kNothing;
    rig.tick(10);
    EXPECT_EQ(rig.device(0).written.force, kNothing);
    EXPECT_FALSE(rig.snapshot().armed);
    EXPECT_EQ(rig.snapshot().devices[0].fault.kind, safety::FaultKind::kOverSpeed);
    EXPECT_TRUE(rig.events().empty());
  }
}

TEST(ServoLoop, ASampleThatIsNoNumberIsAFaultAndNeverReachesTheWorld) {
  ServoRig rig(armed_settings());
  press(rig);
  rig.device(0).sample.position.y = std::numeric_limits<double>::quiet_NaN();
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNotFinite);
  for (const HipSnapshot& hip : rig.snapshot().hips) {
    EXPECT_TRUE(std::isfinite(hip.position.x + hip.position.y + hip.position.z));
    EXPECT_TRUE(std::isfinite(hip.force.x + hip.force.y + hip.force.z));
  }
}

TEST(ServoLoop, ADeviceThatStopsMeasuringIsAFaultOnceItsSampleIsTooOld) {
  ServoRig rig(armed_settings());
  press(rig);
  rig.device(0).fresh = false;
  rig.tick(20);  // 20 ms is allowed
  EXPECT_GT(rig.device(0).written.force.z, 0.5);
  EXPECT_NEAR(rig.snapshot().devices[0].sample_age, 0.020, kRounding);
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kStaleSample);
  EXPECT_NEAR(rig.loop().fault().value, 0.021, kRounding);
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_FALSE(rig.snapshot().devices[0].present);
}

TEST(ServoLoop, ADeviceThatGoesAwayIsAFaultToo) {
  ServoRig rig(armed_settings());
  press(rig);
  rig.device(0).connected = false;
  rig.tick(21);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kStaleSample);
}

TEST(ServoLoop, ADeviceThatWasNeverThereKeepsNobodyFromWorking) {
  ServoRig rig(armed_settings());
  rig.device(1).connected = false;
  press(rig);
  rig.tick(100);
  EXPECT_GT(rig.device(0).written.force.z, 0.5);
  EXPECT_EQ(rig.device(1).written.force, kNothing);
  EXPECT_FALSE(rig.snapshot().devices[1].present);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNone);
}

TEST(ServoLoop, TooManyMissedTicksInARowAreAFaultWhileArmed) {
  ServoRig rig(armed_settings());
  press(rig);
  rig.tick(1, 50);  // as many as are allowed
  EXPECT_GT(rig.device(0).written.force.z, 0.5);
  rig.tick(1, 51);
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kMissedTicks);
  EXPECT_EQ(rig.loop().fault().device, safety::kNoDevice);
  EXPECT_EQ(rig.loop().fault().value, 51.0);
  EXPECT_EQ(rig.snapshot().missed_ticks, 101u);

  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].kind, EventKind::kTicksMissed);
  EXPECT_EQ(events[0].count, 50u);
  EXPECT_EQ(events[1].kind, EventKind::kTicksMissed);
  EXPECT_EQ(events[2].kind, EventKind::kFaultLatched);
}

TEST(ServoLoop, MissedTicksAreNoFaultWhileDisarmed) {
  ServoRig rig({.limits = test::wide_limits()});
  rig.tick(1, 1000);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNone);
  EXPECT_EQ(rig.snapshot().missed_ticks, 1000u);
}

TEST(ServoLoop, ASnapshotTellsTheTick) {
  ServoRig rig(armed_settings());
  press(rig);
  const Snapshot& snapshot = rig.snapshot();
  EXPECT_EQ(snapshot.tick, 1u);
  EXPECT_EQ(snapshot.monotonic_ns, 1'000'000u);
  EXPECT_EQ(snapshot.scene_revision, 1u);
  EXPECT_TRUE(snapshot.armed);
  EXPECT_FALSE(snapshot.paused);

  ASSERT_EQ(snapshot.hips.size(), 2u);
  EXPECT_TRUE(test::near(snapshot.hips[0].position, {0.01, 0.02, -0.01}, kRounding));
  EXPECT_TRUE(test::near(snapshot.hips[0].force, {0.0, 0.0, 1.0}, kRounding));
  ASSERT_EQ(snapshot.objects.size(), 1u);
  EXPECT_TRUE(test::near(snapshot.objects[0].force, {0.0, 0.0, -1.0}, kRounding));

  // both HIPs are in the wall's cells: one on its face, one still in the air
  ASSERT_EQ(snapshot.contacts.size(), 2u);
  EXPECT_EQ(snapshot.contacts[0].hip, 0u);
  EXPECT_EQ(snapshot.contacts[0].object, 0u);
  EXPECT_NE(snapshot.contacts[0].state, engine::ConstraintState::kTet);
  EXPECT_TRUE(test::near(snapshot.contacts[0].proxy, {0.01, 0.02, 0.0}, kRounding));
  EXPECT_TRUE(test::near(snapshot.contacts[0].force, {0.0, 0.0, 1.0}, kRounding));

  ASSERT_EQ(snapshot.devices.size(), 2u);
  EXPECT_TRUE(snapshot.devices[0].present);
  EXPECT_TRUE(test::near(snapshot.devices[0].force, {0.0, 0.0, 1.0}, kRounding));
}

TEST(ServoLoop, ContactsBeyondTheCapacityAreCountedAndCostNoMemory) {
  // the rig reserves 8 contacts; 4 fingers of 4 HIPs at one point are 16
  const std::vector<std::string> names = {"a"};
  ServoRig rig(armed_settings(), names);
  auto scene = test::wall_scene({"a", "a", "a", "a"});
  for (engine::Finger& finger : scene->fingers) finger.hips.resize(4);
  engine::number_hips(*scene);
  rig.mailbox().commands.push(
      {.kind = CommandKind::kSwapScene, .scene = prepare_scene(scene, 2, names).release()});
  {
    const rt::AllocationGuard watch;
    rig.tick(2);
  }
  EXPECT_EQ(rig.snapshot().contacts.size(), 8u);
  EXPECT_EQ(rig.snapshot().dropped_contacts, 8u);
  for (const Event& event : rig.events()) delete event.scene;
}

std::uint64_t false_time = 0;
std::uint64_t false_clock() noexcept { return false_time += 10; }

TEST(ServoLoop, PublishesItsStatsEveryHundredTicks) {
  ServoSettings settings = armed_settings();
  settings.clock = &false_clock;
  ServoRig rig(settings);
  rig.tick(99);
  EXPECT_FALSE(rig.mailbox().stats.update());
  rig.tick();
  ASSERT_TRUE(rig.mailbox().stats.update());
  const LoopStats& stats = rig.mailbox().stats.latest();
  EXPECT_EQ(stats.tick, 99u);
  EXPECT_EQ(stats.wakeup.total(), 100u);
  for (const rt::LatencyHistogram& stage : stats.stages) EXPECT_EQ(stage.total(), 100u);
  // between the readings around a stage without a timed engine lies one step of the clock
  EXPECT_EQ(stats.stages[static_cast<std::size_t>(Stage::kGuard)].max_ns(), 10u);

  std::uint64_t counted = 0;
  std::uint64_t timed = 0;
  for (const auto& row : stats.transitions.count) {
    for (const std::uint64_t cell : row) counted += cell;
  }
  for (const auto& row : stats.transitions.timed) {
    for (const std::uint64_t cell : row) timed += cell;
  }
  EXPECT_GE(counted, 2u * 99u);
  EXPECT_GT(timed, 0u);
  EXPECT_LT(timed, counted / 10) << "transitions are timed in few ticks only";
}

TEST(ServoLoop, WithoutAClockNothingIsTimed) {
  ServoRig rig(armed_settings());
  rig.tick(100);
  ASSERT_TRUE(rig.mailbox().stats.update());
  for (const rt::LatencyHistogram& stage : rig.mailbox().stats.latest().stages) EXPECT_EQ(stage.total(), 0u);
}

TEST(ServoLoop, NeverAllocatesLocksOrThrowsWhateverHappens) {
  ServoSettings settings = armed_settings();
  settings.clock = &false_clock;
  ServoRig rig(settings);
  // prepared beforehand: commands of every kind, a scene, and queues that run over
  for (int round = 0; round < 3; ++round) {
    for (const CommandKind kind : {CommandKind::kArm, CommandKind::kPause, CommandKind::kStep,
                                   CommandKind::kResume, CommandKind::kReset, CommandKind::kResetStats,
                                   CommandKind::kClearFault, CommandKind::kDisarm, CommandKind::kArm}) {
      rig.send(kind, 1, 3);
    }
    rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .scene = rig.prepare(2).release()});
  }
  {
    const rt::AllocationGuard watch;
    rig.device(0).sample.position = {0.01, 0.02, 0.005};
    rig.tick(50);
    rig.device(0).sample.position.z = -0.01;
    rig.tick(50);
    rig.device(0).sample.velocity.x = 100.0;  // a fault
    rig.tick(2);
    rig.device(1).sample.position.x = std::numeric_limits<double>::infinity();
    rig.tick(2);
    rig.device(1).connected = false;
    rig.tick(3000, 1);  // more events than the queue holds
  }
  for (const Event& event : rig.events()) delete event.scene;
}

TEST(ServoLoop, GivesTheSameBitsForTheSameSamplesAndCommands) {
  const auto run = [] {
    ServoRig rig(armed_settings());
    for (int i = 0; i < 500; ++i) {
      rig.device(0).sample.position = {0.03 * std::sin(i * 0.01), 0.02, 0.01 * std::cos(i * 0.05)};
      if (i == 200) rig.send(CommandKind::kReset);
      rig.tick();
    }
    return engine::hash(rig.loop().scene().world.state());
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace haptic::servo
