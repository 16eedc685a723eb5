#include "ipc/publisher.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

struct Received {
  std::uint32_t subscription;
  std::uint64_t sequence;
  SharedBytes body;
  std::uint64_t tick() const {
    v1::Frame frame;
    frame.ParseFromString(*body);
    return frame.tick();
  }
};

struct Collector {
  std::vector<Received> frames;
  FrameSink sink() {
    return [this](std::uint32_t subscription, std::uint64_t sequence, SharedBytes body) {
      frames.push_back({subscription, sequence, std::move(body)});
    };
  }
  std::vector<std::uint64_t> ticks() const {
    std::vector<std::uint64_t> all;
    for (const Received& frame : frames) {
      all.push_back(frame.tick());
    }
    return all;
  }
  std::vector<std::uint64_t> sequences() const {
    std::vector<std::uint64_t> all;
    for (const Received& frame : frames) {
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
  publisher.subscribe(1, kObjects, 0, each.sink());
  publisher.subscribe(1, kObjects, 5, fifth.sink());
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
  publisher.subscribe(1, kObjects, 5, fifth.sink());
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
  publisher.subscribe(1, kObjects, 1, each.sink());
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
  publisher.subscribe(1, kObjects, 5, fifth.sink());
  publisher.publish(at(0));
  publisher.publish(at(21));  // groups of 5, 10 and 15 were lost, 20 is late
  EXPECT_EQ(fifth.sequences(), (Numbers{1, 5}));
}

TEST(Publisher, GivesTheSameBytesToAllWhoWantTheSame) {
  Publisher publisher;
  Collector first;
  Collector second;
  Collector other;
  publisher.subscribe(1, kObjects, 1, first.sink());
  publisher.subscribe(2, kObjects, 2, second.sink());
  publisher.subscribe(3, topic_bit(v1::HIPS), 1, other.sink());
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
  publisher.subscribe(1, kObjects, 1, early.sink());
  publisher.publish(at(1));
  publisher.publish(at(2));
  publisher.subscribe(2, kObjects, 1, late.sink());
  publisher.publish(at(9));
  EXPECT_EQ(late.sequences(), (Numbers{1}));
}

TEST(Publisher, EndsOnlyTheSubscriptionsOfTheClientThatAsks) {
  Publisher publisher;
  Collector mine;
  Collector theirs;
  publisher.subscribe(1, kObjects, 1, mine.sink());
  const std::uint32_t number = publisher.subscribe(2, kObjects, 1, theirs.sink());
  EXPECT_FALSE(publisher.unsubscribe(1, number));
  publisher.publish(at(1));
  EXPECT_TRUE(publisher.unsubscribe(2, number));
  publisher.publish(at(2));
  publisher.forget(1);
  publisher.publish(at(3));
  EXPECT_EQ(theirs.frames.size(), 1U);
  EXPECT_EQ(mine.frames.size(), 2U);
}

}  // namespace
}  // namespace haptic::ipc
