#include "ipc/publisher.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

v1::Frame parsed(const OutgoingFrame& frame) {
  v1::Frame out;
  out.ParseFromString(*frame.body);
  return out;
}

struct Collector {
  std::vector<OutgoingFrame> frames;
  FrameSink sink() {
    return [this](const OutgoingFrame& frame) { frames.push_back(frame); };
  }
  std::vector<std::uint64_t> ticks() const {
    std::vector<std::uint64_t> all;
    for (const OutgoingFrame& frame : frames) {
      all.push_back(parsed(frame).tick());
    }
    return all;
  }
  std::vector<std::uint64_t> sequences() const {
    std::vector<std::uint64_t> all;
    for (const OutgoingFrame& frame : frames) {
      all.push_back(frame.sequence);
    }
    return all;
  }
};

servo::Snapshot at(std::uint64_t tick, std::uint64_t missed = 0) {
  servo::Snapshot snapshot;
  snapshot.tick = tick;
  snapshot.missed_ticks = missed;
  return snapshot;
}

using Numbers = std::vector<std::uint64_t>;
constexpr TopicSet kObjects = topic_bit(v1::OBJECTS);

TEST(Publisher, DecimatesByTickCount) {
  Publisher publisher;
  Collector each;
  Collector fifth;
  publisher.subscribe(1, {kObjects, 0}, each.sink());
  publisher.subscribe(1, {kObjects, 5}, fifth.sink());
  for (std::uint64_t tick = 0; tick <= 12; ++tick) {
    publisher.publish(at(tick));
  }
  EXPECT_EQ(each.frames.size(), 13U);
  EXPECT_EQ(fifth.ticks(), (Numbers{0, 5, 10}));
  EXPECT_EQ(fifth.sequences(), (Numbers{1, 2, 3}));
}

TEST(Publisher, SendsAFrameForAGroupWhoseFirstTickWasMissed) {
  Publisher publisher;
  Collector fifth;
  publisher.subscribe(1, {kObjects, 5}, fifth.sink());
  publisher.publish(at(4));
  publisher.publish(at(7, 2));  // 5 and 6 were slept through
  publisher.publish(at(8, 2));
  publisher.publish(at(10, 3));
  EXPECT_EQ(fifth.ticks(), (Numbers{4, 7, 10}));
  EXPECT_EQ(fifth.sequences(), (Numbers{1, 2, 3}));
}

TEST(Publisher, CountsLostSnapshotsButNotMissedTicks) {
  Publisher publisher;
  Collector each;
  publisher.subscribe(1, {kObjects, 1}, each.sink());
  publisher.publish(at(10));
  publisher.publish(at(14));     // 11, 12, 13 were lost on the way
  publisher.publish(at(20, 5));  // 15 to 19 never ran
  publisher.publish(at(24, 6));  // of 21, 22, 23 one never ran, two were lost
  // 1; 1 + 1 + 3; + 1; + 1 + 2
  EXPECT_EQ(each.sequences(), (Numbers{1, 5, 6, 9}));
}

TEST(Publisher, CountsWholeGroupsThatWereLost) {
  Publisher publisher;
  Collector fifth;
  publisher.subscribe(1, {kObjects, 5}, fifth.sink());
  publisher.publish(at(0));
  publisher.publish(at(21));  // groups of 5, 10 and 15 were lost, 20 is late
  EXPECT_EQ(fifth.sequences(), (Numbers{1, 5}));
}

TEST(Publisher, GivesTheSameBytesToAllWhoWantTheSame) {
  Publisher publisher;
  Collector first;
  Collector second;
  Collector other;
  publisher.subscribe(1, {kObjects, 1}, first.sink());
  publisher.subscribe(2, {kObjects, 2}, second.sink());
  publisher.subscribe(3, {topic_bit(v1::HIPS), 1}, other.sink());
  publisher.publish(at(2));
  ASSERT_EQ(first.frames.size(), 1U);
  ASSERT_EQ(second.frames.size(), 1U);
  EXPECT_EQ(first.frames[0].body.get(), second.frames[0].body.get());
  EXPECT_NE(first.frames[0].body.get(), other.frames[0].body.get());
}

TEST(Publisher, StartsEachSubscriptionAtSequenceOne) {
  Publisher publisher;
  Collector early;
  Collector late;
  publisher.subscribe(1, {kObjects, 1}, early.sink());
  publisher.publish(at(1));
  publisher.publish(at(2));
  publisher.subscribe(2, {kObjects, 1}, late.sink());
  publisher.publish(at(9));
  EXPECT_EQ(late.sequences(), (Numbers{1}));
}

TEST(Publisher, EndsOnlyTheSubscriptionsOfTheClientThatAsks) {
  Publisher publisher;
  Collector mine;
  Collector theirs;
  publisher.subscribe(1, {kObjects, 1}, mine.sink());
  const std::uint32_t number = publisher.subscribe(2, {kObjects, 1}, theirs.sink());
  EXPECT_FALSE(publisher.unsubscribe(1, number));
  publisher.publish(at(1));
  EXPECT_TRUE(publisher.unsubscribe(2, number));
  publisher.publish(at(2));
  publisher.forget(1);
  publisher.publish(at(3));
  EXPECT_EQ(theirs.frames.size(), 1U);
  EXPECT_EQ(mine.frames.size(), 2U);
}

TEST(Publisher, TellsTicksAndTopicsOfLostSnapshots) {
  Publisher publisher;
  Collector each;
  publisher.subscribe(1, {kObjects | topic_bit(v1::EVENTS), 1}, each.sink());
  publisher.publish(at(10));
  publisher.publish(at(14));
  EXPECT_EQ(each.frames[0].lost_before.topics, 0U);
  EXPECT_EQ(each.frames[1].lost_before.topics, kObjects);
  EXPECT_EQ(each.frames[1].lost_before.first_tick, 11U);
  EXPECT_EQ(each.frames[1].lost_before.last_tick, 13U);
}

TEST(Publisher, SendsEventsAndStatisticsInFramesOfTheirOwnInOneSequence) {
  Publisher publisher;
  Collector all;
  Collector ticks;
  Collector events;
  const TopicSet told = topic_bit(v1::EVENTS) | topic_bit(v1::STATS);
  publisher.subscribe(1, {kObjects | told, 10}, all.sink());
  publisher.subscribe(1, {kObjects, 10}, ticks.sink());
  publisher.subscribe(2, {topic_bit(v1::EVENTS), 10}, events.sink());
  v1::Event event;
  event.set_tick(3);
  event.set_kind(v1::Event::ARMED);
  v1::Stats stats;
  stats.set_tick(4);
  publisher.publish(event);
  publisher.publish(at(3));
  publisher.publish(event);  // events are not decimated
  publisher.publish(stats);
  publisher.publish(stats);  // within the same 10 ticks

  ASSERT_EQ(all.sequences(), (Numbers{1, 2, 3, 4}));
  EXPECT_EQ(parsed(all.frames[0]).event().kind(), v1::Event::ARMED);
  EXPECT_TRUE(parsed(all.frames[1]).has_objects());
  EXPECT_FALSE(parsed(all.frames[1]).has_event());
  EXPECT_EQ(parsed(all.frames[3]).stats().tick(), 4U);
  EXPECT_EQ(ticks.frames.size(), 1U);
  EXPECT_EQ(events.frames.size(), 2U);
  EXPECT_EQ(events.frames[0].body.get(), all.frames[0].body.get());
}

v1::SceneDescription scene_of(std::uint64_t revision, const std::vector<std::string>& objects) {
  v1::SceneDescription scene;
  scene.set_revision(revision);
  for (const std::string& name : objects) {
    scene.add_object()->set_name(name);
  }
  return scene;
}

servo::Snapshot with_objects(std::uint64_t tick, std::uint64_t revision, std::size_t count) {
  servo::Snapshot snapshot = at(tick);
  snapshot.scene_revision = revision;
  snapshot.objects.resize(count);
  return snapshot;
}

std::vector<std::uint32_t> objects_in(const OutgoingFrame& frame) {
  const v1::Frame read = parsed(frame);
  EXPECT_EQ(read.objects().position_size(), 3 * read.objects().object_size());
  return {read.objects().object().begin(), read.objects().object().end()};
}

TEST(Publisher, LooksNamesUpAnewInEachScene) {
  Publisher publisher;
  Collector cup;
  publisher.learn(scene_of(1, {"table", "cup"}));
  publisher.subscribe(1, {.topics = kObjects, .filter = {.fingers = {}, .objects = {"cup"}}}, cup.sink());
  publisher.publish(with_objects(1, 1, 2));
  publisher.learn(scene_of(2, {"cup"}));
  publisher.publish(with_objects(2, 1, 2));  // was on its way when the scene changed
  publisher.publish(with_objects(3, 2, 1));
  publisher.learn(scene_of(3, {"table"}));
  publisher.publish(with_objects(4, 3, 1));  // removed: frames go on without it
  publisher.publish(with_objects(5, 9, 3));  // a scene that nobody told of
  using Indices = std::vector<std::uint32_t>;
  ASSERT_EQ(cup.frames.size(), 5U);
  EXPECT_EQ(objects_in(cup.frames[0]), Indices{1});
  EXPECT_EQ(objects_in(cup.frames[1]), Indices{1});
  EXPECT_EQ(objects_in(cup.frames[2]), Indices{0});
  EXPECT_EQ(objects_in(cup.frames[3]), Indices{});
  EXPECT_EQ(objects_in(cup.frames[4]), Indices{});
}

TEST(Publisher, AsksForASceneBeforeItsFirstSnapshot) {
  servo::SnapshotRing ring(
      servo::Capacity{.objects = 4, .fingers = 1, .hips = 1, .contacts = 1, .devices = 1});
  Publisher publisher;
  Collector cup;
  publisher.learn(scene_of(1, {"table", "cup"}));
  publisher.subscribe(1, {.topics = kObjects, .filter = {.fingers = {}, .objects = {"cup"}}}, cup.sink());
  ring.writable().tick = 1;
  ring.writable().scene_revision = 2;
  ring.writable().objects.resize(1);
  ring.publish();
  publisher.drain(ring, [&] { publisher.learn(scene_of(2, {"cup"})); });
  ASSERT_EQ(cup.frames.size(), 1U);
  EXPECT_EQ(objects_in(cup.frames[0]), std::vector<std::uint32_t>{0});
}

TEST(Publisher, SharesBytesBetweenEqualFiltersOnly) {
  Publisher publisher;
  publisher.learn(scene_of(1, {"table", "cup"}));
  Collector first;
  Collector second;
  Collector other;
  const Filter cup{.fingers = {}, .objects = {"cup"}};
  publisher.subscribe(1, {.topics = kObjects, .filter = cup}, first.sink());
  publisher.subscribe(2, {.topics = kObjects, .delivery = v1::LATEST, .filter = cup}, second.sink());
  publisher.subscribe(3, {.topics = kObjects}, other.sink());
  publisher.publish(with_objects(1, 1, 2));
  EXPECT_EQ(first.frames[0].body.get(), second.frames[0].body.get());
  EXPECT_NE(first.frames[0].body.get(), other.frames[0].body.get());
}

}  // namespace
}  // namespace haptic::ipc
