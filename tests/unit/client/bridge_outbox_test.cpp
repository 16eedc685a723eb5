#include <gtest/gtest.h>

#include <thread>

#include "client/bridge/outbox.h"

namespace haptic::bridge {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLimit = 1000;

v1::Frame frame(std::uint64_t sequence, std::uint32_t subscription = 1) {
  v1::Frame out;
  out.set_sequence(sequence);
  out.set_subscription(subscription);
  out.set_tick(10 * sequence);
  return out;
}

// of some 100 bytes
v1::Frame large(std::uint64_t sequence) {
  v1::Frame out = frame(sequence);
  for (int i = 0; i < 11; ++i) {
    out.mutable_objects()->add_position(1.0);
  }
  return out;
}

Outbox outbox(Keep keep) {
  return Outbox({{.subject = "o", .topic = v1::OBJECTS, .keep = keep},
                 {.subject = "h", .topic = v1::HIPS, .keep = keep}},
                "gap", kLimit);
}

// "o1 gap2-4 o5": all that can be taken
std::string drain(Outbox& box) {
  std::string text;
  while (const auto message = box.take(0ms)) {
    text += text.empty() ? "" : " ";
    if (message->is_gap) {
      v1::Gap gap;
      EXPECT_EQ(message->subject, "gap");
      EXPECT_TRUE(gap.ParseFromString(message->payload));
      text += "gap" + std::to_string(gap.first_sequence()) + "-" + std::to_string(gap.last_sequence());
    } else {
      v1::Frame got;
      EXPECT_TRUE(got.ParseFromString(message->payload));
      text += message->subject + std::to_string(got.sequence());
    }
    box.published(*message);
  }
  return text;
}

v1::BridgeStatus::Flow flow(const Outbox& box, int lane) {
  v1::BridgeStatus status;
  box.report(status);
  return status.flow(lane);
}

TEST(Outbox, GivesTheBytesOfTheFrameThatCameIn) {
  Outbox box = outbox(Keep::kAll);
  box.add(0, large(3));
  EXPECT_EQ(box.take(0ms)->payload, large(3).SerializeAsString());
}

TEST(Outbox, KeepsTheOrderOfArrivalOverItsLanes) {
  Outbox box = outbox(Keep::kAll);
  box.add(0, frame(1));
  box.add(1, frame(1));
  box.add(1, frame(2));
  box.add(0, frame(2));
  EXPECT_EQ(drain(box), "o1 h1 h2 o2");
}

TEST(Outbox, ReplacesAnOlderFrameAndTellsOfItBeforeTheNewer) {
  Outbox box = outbox(Keep::kLatest);
  for (std::uint64_t sequence = 1; sequence <= 4; ++sequence) {
    box.add(0, frame(sequence));
  }
  box.add(1, frame(7));
  EXPECT_EQ(drain(box), "gap1-3 o4 h7");
  EXPECT_EQ(flow(box, 0).lost(), 3U);
  EXPECT_EQ(flow(box, 0).published(), 1U);
}

TEST(Outbox, DropsTheOldestBeyondItsLimitOfBytes) {
  Outbox box = outbox(Keep::kAll);
  const std::size_t each = large(1).SerializeAsString().size();
  const std::uint64_t fit = kLimit / each;
  ASSERT_GT(fit, 5U);
  for (std::uint64_t sequence = 1; sequence <= fit + 3; ++sequence) {
    box.add(0, large(sequence));
  }
  EXPECT_EQ(flow(box, 0).waiting(), fit);
  EXPECT_EQ(drain(box).substr(0, 9), "gap1-3 o4");
}

TEST(Outbox, TellsTicksTopicAndSubscriptionOfWhatIsLost) {
  Outbox box = outbox(Keep::kLatest);
  box.add(1, frame(5, 9));
  box.add(1, frame(6, 9));
  box.add(1, frame(7, 9));
  const v1::Gap gap = box.take(0ms)->range;
  EXPECT_EQ(gap.subscription(), 9U);
  EXPECT_EQ(gap.first_tick(), 50U);
  EXPECT_EQ(gap.last_tick(), 60U);
  ASSERT_EQ(gap.topic_size(), 1);
  EXPECT_EQ(gap.topic(0), v1::HIPS);
}

TEST(Outbox, JoinsWhatTheDaemonLostToWhatItLosesItself) {
  Outbox box = outbox(Keep::kLatest);
  box.add(0, frame(1));
  v1::Gap gap;
  gap.set_subscription(1);
  gap.set_first_sequence(2);
  gap.set_last_sequence(5);
  box.add_gap(0, gap);
  box.add(0, frame(6));
  EXPECT_EQ(drain(box), "gap1-5 o6");
  EXPECT_EQ(flow(box, 0).lost(), 1U);
  EXPECT_EQ(flow(box, 0).lost_before(), 4U);
}

TEST(Outbox, TellsWhatTheDaemonLostAfterTheFramesBeforeIt) {
  Outbox box = outbox(Keep::kAll);
  box.add(0, frame(1));
  v1::Gap gap;
  gap.set_subscription(1);
  gap.set_first_sequence(2);
  gap.set_last_sequence(2);
  box.add_gap(0, gap);
  box.add(0, frame(3));
  EXPECT_EQ(drain(box), "o1 gap2-2 o3");
}

TEST(Outbox, DoesNotJoinGapsOfTwoSessions) {
  Outbox box = outbox(Keep::kLatest);
  box.add(0, frame(8));
  box.add(0, frame(1));  // of a daemon that has started again
  box.add(0, frame(2));
  EXPECT_EQ(drain(box), "gap8-8 gap1-1 o2");
}

TEST(Outbox, TellsOfAFrameThatDidNotGetOutBeforeTheNext) {
  Outbox box = outbox(Keep::kAll);
  box.add(0, frame(1));
  box.add(0, frame(2));
  box.failed(*box.take(0ms));
  EXPECT_EQ(drain(box), "gap1-1 o2");
  box.add(0, frame(3));
  box.failed(*box.take(0ms));
  EXPECT_EQ(drain(box), "");
  box.add(0, frame(4));
  EXPECT_EQ(drain(box), "gap3-3 o4");
  EXPECT_EQ(flow(box, 0).lost(), 2U);
}

TEST(Outbox, TellsAGapAgainThatDidNotGetOut) {
  Outbox box = outbox(Keep::kLatest);
  box.add(0, frame(1));
  box.add(0, frame(2));
  const auto gap = box.take(0ms);
  ASSERT_TRUE(gap->is_gap);
  box.add(0, frame(3));
  box.failed(*gap);
  EXPECT_EQ(drain(box), "gap1-2 o3");
  EXPECT_EQ(flow(box, 0).lost(), 2U);
}

TEST(Outbox, CountsFramesBytesAndWhatWaits) {
  Outbox box = outbox(Keep::kAll);
  box.add(0, frame(1));
  box.add(0, frame(2));
  EXPECT_EQ(flow(box, 0).waiting(), 2U);
  EXPECT_FALSE(box.is_empty());
  drain(box);
  EXPECT_TRUE(box.is_empty());
  EXPECT_EQ(flow(box, 0).published(), 2U);
  EXPECT_EQ(flow(box, 0).bytes(), frame(1).SerializeAsString().size() + frame(2).SerializeAsString().size());
  EXPECT_EQ(flow(box, 1).published(), 0U);
}

TEST(Outbox, LosesNoFrameUntoldWhileOneThreadAddsAndAnotherTakes) {
  constexpr std::uint64_t kFrames = 20'000;
  Outbox box = outbox(Keep::kLatest);
  std::jthread writer([&box] {
    for (std::uint64_t sequence = 1; sequence <= kFrames; ++sequence) {
      box.add(0, frame(sequence));
    }
  });
  std::uint64_t told = 0;
  while (told < kFrames) {
    const auto message = box.take(10s);
    ASSERT_TRUE(message);
    ASSERT_EQ(message->range.first_sequence(), told + 1);
    told = message->range.last_sequence();
    box.published(*message);
  }
  EXPECT_EQ(flow(box, 0).published() + flow(box, 0).lost(), kFrames);
}

}  // namespace
}  // namespace haptic::bridge
