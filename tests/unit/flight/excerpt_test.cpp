// What is written of a tape: the ticks are those of a real world (recording_rig.h), and what was written is
// replayed.

#include "flight/excerpt.h"

#include <gtest/gtest.h>

#include <map>

#include "proto/recording/recording.h"
#include "tests/support/memory_sink.h"
#include "tests/support/recording_rig.h"

namespace haptic::flight {
namespace {

constexpr std::uint64_t kNanosecondsPerTick = 1'000'000;

/// A tape as the daemon fills it, of all that the rig has told.
class Flight {
 public:
  void keep(const test::Item& item) {
    if (const auto* scene = std::get_if<v1::SceneDescription>(&item)) {
      scenes.push_back({.from_tick = tick_ + 1, .told = std::make_shared<v1::SceneDescription>(*scene)});
    } else if (const auto* state = std::get_if<v1::WorldState>(&item)) {
      tape.append({.kind = EntryKind::kState, .tick = state->tick()}, state->SerializeAsString());
    } else {
      v1::Frame frame = std::get<v1::Frame>(item);
      tick_ = frame.tick();
      frame.set_realtime_ns(tick_ * kNanosecondsPerTick);
      tape.append({.kind = EntryKind::kTick, .tick = tick_, .sequence = ++sequence, .subscription = 1},
                  frame.SerializeAsString());
    }
  }

  void keep_event(std::uint64_t tick) {
    v1::Frame frame;
    frame.set_tick(tick);
    frame.set_realtime_ns(tick * kNanosecondsPerTick);
    frame.set_scene_revision(1);
    frame.mutable_event()->set_kind(v1::Event::FAULT_LATCHED);
    tape.append({.kind = EntryKind::kOther, .tick = tick, .sequence = ++sequence, .subscription = 1},
                frame.SerializeAsString());
  }

  /// The file with the ticks from this one on.
  void write_from(std::uint64_t first_tick) {
    Excerpt excerpt{.session = {.program = "test", .daemon_version = "1", .rate_hz = 1000.0},
                    .first_tick = first_tick,
                    .entries = tape.hold(),
                    .scenes = scenes,
                    .devices = {}};
    excerpt.devices.add_device()->mutable_description()->set_name("left");
    excerpt.devices.add_device()->mutable_description()->set_name("right");
    test::MemorySink sink;
    write(excerpt, sink);
    bytes = sink.bytes;
  }

  replay::Report replay() const {
    const recording::MemorySource source(bytes);
    const recording::Recording recording(source);
    EXPECT_EQ(recording.damage(), "");
    replay::Replayer replayer;
    // in the order of the file
    for (auto messages = recording.messages(); messages.next();) {
      const std::string& topic = messages.channel().topic;
      if (topic == recording::kSceneTopic) {
        v1::SceneDescription scene;
        messages.parse(scene);
        replayer.add_scene(scene);
      } else if (topic == recording::kStateTopic) {
        v1::WorldState state;
        messages.parse(state);
        replayer.take(state);
      } else if (topic == recording::channel_of(v1::INPUTS)) {
        v1::Frame frame;
        messages.parse(frame);
        replayer.take(frame);
      }
    }
    return replayer.report();
  }

  std::map<std::string, std::uint64_t> counts() const {
    const recording::MemorySource source(bytes);
    const recording::Recording recording(source);
    std::map<std::string, std::uint64_t> found;
    for (auto messages = recording.messages(); messages.next();) ++found[messages.channel().topic];
    return found;
  }

  Tape tape{std::size_t{64} << 20U};
  std::vector<KeptScene> scenes;
  std::string bytes;
  std::uint64_t sequence = 0;

 private:
  std::uint64_t tick_ = 0;
};

Flight flight_of(const test::RecordingRig& rig) {
  Flight flight;
  for (const test::Item& item : rig.items()) flight.keep(item);
  return flight;
}

TEST(Excerpt, BeginsAtTheLastStateBeforeWhatIsWantedAndIsReplayedToTheBit) {
  test::RecordingRig rig;
  rig.tick(100);
  rig.tick_and_copy();  // tick 100
  rig.tick(99);
  rig.tick_and_copy();  // tick 200
  rig.tick(99);
  rig.tick_and_copy();  // tick 300
  rig.tick(99);         // up to 399
  Flight flight = flight_of(rig);
  flight.write_from(250);
  const replay::Report report = flight.replay();
  EXPECT_FALSE(report.difference);
  EXPECT_EQ(report.first_tick, 201U);
  EXPECT_EQ(report.last_tick, 399U);
  EXPECT_EQ(report.compared, 199U);
  EXPECT_EQ(report.starts, 1U) << "the state after tick 300 is compared, and nothing begins there";
}

TEST(Excerpt, BeginsWithTheTimeOfItsFirstTick) {
  test::RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(100);
  Flight flight = flight_of(rig);
  flight.write_from(50);
  const recording::MemorySource source(flight.bytes);
  const recording::Statistics statistics = recording::Recording(source).statistics();
  EXPECT_EQ(statistics.start_time, 1 * kNanosecondsPerTick);
  EXPECT_EQ(statistics.end_time, 100 * kNanosecondsPerTick);
}

TEST(Excerpt, HoldsTheLookOfEachTickTheDevicesTheSceneAndTheEvents) {
  test::RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(50);
  Flight flight = flight_of(rig);
  flight.keep_event(50);
  flight.write_from(1);
  auto counts = flight.counts();
  for (const v1::Topic topic : {v1::OBJECTS, v1::HIPS, v1::DEVICES, v1::INPUTS}) {
    EXPECT_EQ(counts[recording::channel_of(topic)], 50U) << v1::Topic_Name(topic);
  }
  EXPECT_EQ(counts[recording::channel_of(v1::EVENTS)], 1U);
  EXPECT_EQ(counts[recording::kDevicesTopic], 1U);
  EXPECT_EQ(counts[recording::kSceneTopic], 1U);
  EXPECT_EQ(counts[recording::kStateTopic], 1U);
  EXPECT_EQ(counts[recording::kGapsTopic], 0U);
}

TEST(Excerpt, IsReplayedThroughEditsAndLoadsOfTheScene) {
  test::RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(300);
  rig.edit("edit { set_gravity { y: -0.3 } }");
  rig.tick(50);
  rig.load_scene(test::grasp_scene());
  rig.tick(50);
  Flight flight = flight_of(rig);
  flight.write_from(200);
  const replay::Report report = flight.replay();
  EXPECT_FALSE(report.difference);
  EXPECT_TRUE(report.gaps.empty());
  EXPECT_EQ(report.last_tick, 400U);
  EXPECT_EQ(flight.counts()[recording::kSceneTopic], 3U);
}

TEST(Excerpt, LeavesOutTicksOfASceneThatIsNoLongerKnown) {
  test::RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(50);
  rig.load_scene(test::grasp_scene());
  rig.tick(50);
  rig.tick_and_copy();
  rig.tick(50);
  Flight flight = flight_of(rig);
  flight.scenes.erase(flight.scenes.begin());
  flight.write_from(10);
  const replay::Report report = flight.replay();
  EXPECT_FALSE(report.difference);
  EXPECT_EQ(report.compared, 50U);
  EXPECT_EQ(flight.counts()[recording::channel_of(v1::HIPS)], 101U);
}

TEST(Excerpt, TellsWhichTicksWereLost) {
  test::RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(20);
  Flight flight;
  for (const test::Item& item : rig.items()) {
    const auto* frame = std::get_if<v1::Frame>(&item);
    const bool is_lost = frame != nullptr && frame->tick() >= 8 && frame->tick() <= 11;
    if (is_lost) {
      ++flight.sequence;
    } else {
      flight.keep(item);
    }
  }
  flight.write_from(1);
  const recording::MemorySource source(flight.bytes);
  const recording::Recording recording(source);
  auto gaps = recording.messages({.topics = {recording::kGapsTopic}});
  ASSERT_TRUE(gaps.next());
  v1::Gap gap;
  gaps.parse(gap);
  EXPECT_EQ(gap.first_tick(), 8U);
  EXPECT_EQ(gap.last_tick(), 11U);
  EXPECT_EQ(gap.last_sequence() - gap.first_sequence() + 1, 4U);
  EXPECT_FALSE(gaps.next());
}

TEST(Excerpt, OfATapeWithoutAStateCanStillBeLookedAt) {
  test::RecordingRig rig;
  rig.tick(30);
  Flight flight = flight_of(rig);
  flight.write_from(10);
  EXPECT_EQ(flight.counts()[recording::channel_of(v1::HIPS)], 20U);
  EXPECT_EQ(flight.replay().compared, 0U);
}

TEST(Excerpt, TellsOfASinkThatIsFull) {
  test::RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(30);
  Flight flight = flight_of(rig);
  Excerpt excerpt{
      .session = {}, .first_tick = 1, .entries = flight.tape.hold(), .scenes = flight.scenes, .devices = {}};
  test::MemorySink sink;
  sink.room = 3000;
  EXPECT_THROW(write(excerpt, sink), recording::IoError);
}

}  // namespace
}  // namespace haptic::flight
