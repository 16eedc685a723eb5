// A client that stops reading, seen from its own end and from that of others: what it gets when it reads
// again, and that nobody else misses anything.

#include <gtest/gtest.h>

#include "client/lib/connection.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using client::Connection;
using test::TestDaemon;

constexpr std::uint64_t kTicks = 60;
constexpr std::size_t kBound = 4;  // frames that wait for one client

ServerSettings bounded() {
  ServerSettings settings;
  settings.session.outbox.data_frames = kBound;
  return settings;
}

Connection connect(const TestDaemon& daemon) {
  client::Options options;
  options.address = daemon.address();
  return Connection(options);
}

void subscribe(Connection& client, v1::Delivery delivery) {
  v1::Subscribe wish;
  wish.add_topic(v1::HIPS);
  wish.set_delivery(delivery);
  client.subscribe(std::move(wish));
}

// frames of 4096 HIPs have about 200 kB each: the buffers of a socket take one or two of them. The brisk
// client reads each before the next is published.
void publish_all(TestDaemon& daemon, Connection& brisk) {
  for (std::uint64_t tick = 1; tick <= kTicks; ++tick) {
    daemon.servo().publish(tick, [](servo::Snapshot& snapshot) { snapshot.hips.resize(4096); });
    const auto message = brisk.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message && message->has_frame()) << "at tick " << tick;
    ASSERT_EQ(message->frame().sequence(), tick);
  }
}

struct Read {
  std::vector<std::uint64_t> before;  // sequences of frames before the gap
  v1::Gap gap;
  std::vector<std::uint64_t> after;
};

// all that the stalled client finds; there must be one gap
Read read_all(Connection& stalled) {
  Read read;
  while (read.after.empty() || read.after.back() < kTicks) {
    const auto message = stalled.receive(std::chrono::seconds(5));
    if (!message) {
      ADD_FAILURE() << "the newest frame did not come";
      return read;
    }
    if (message->has_gap()) {
      EXPECT_EQ(read.gap.last_sequence(), 0U) << "a second gap";
      read.gap = message->gap();
    } else {
      EXPECT_EQ(message->frame().tick(), message->frame().sequence());
      (read.gap.last_sequence() == 0 ? read.before : read.after).push_back(message->frame().sequence());
    }
  }
  return read;
}

// 1, 2, ... up to the gap, which names what is missing
void expect_gap(const Read& read, std::uint64_t last_lost) {
  for (std::size_t i = 0; i < read.before.size(); ++i) {
    EXPECT_EQ(read.before[i], i + 1);
  }
  EXPECT_EQ(read.gap.first_sequence(), read.before.size() + 1);
  EXPECT_EQ(read.gap.last_sequence(), last_lost);
  EXPECT_EQ(read.gap.first_tick(), read.gap.first_sequence());  // one frame for each tick, from 1 on
  EXPECT_EQ(read.gap.last_tick(), read.gap.last_sequence());
  ASSERT_EQ(read.gap.topic_size(), 1);
  EXPECT_EQ(read.gap.topic(0), v1::HIPS);
}

class StalledClient : public testing::Test {
 protected:
  TestDaemon daemon_{bounded()};
  Connection stalled_ = connect(daemon_);
  Connection brisk_ = connect(daemon_);
};

TEST_F(StalledClient, WithLatestGetsTheNewestAndAGapOfAllThatItMissed) {
  subscribe(stalled_, v1::LATEST);
  subscribe(brisk_, v1::LOSSLESS);
  publish_all(daemon_, brisk_);
  const Read read = read_all(stalled_);
  expect_gap(read, kTicks - 1);
  EXPECT_EQ(read.after, std::vector<std::uint64_t>{kTicks});
}

TEST_F(StalledClient, WithLosslessLosesTheOldestBeyondTheBoundAndAGapNamesThem) {
  subscribe(stalled_, v1::LOSSLESS);
  subscribe(brisk_, v1::LOSSLESS);
  publish_all(daemon_, brisk_);
  const Read read = read_all(stalled_);
  expect_gap(read, kTicks - kBound);
  EXPECT_EQ(read.after, (std::vector<std::uint64_t>{kTicks - 3, kTicks - 2, kTicks - 1, kTicks}));
}

TEST_F(StalledClient, OfLatestDoesNotKeepAnotherOfLatestFromAnyFrame) {
  subscribe(stalled_, v1::LATEST);
  subscribe(brisk_, v1::LATEST);
  publish_all(daemon_, brisk_);
}

}  // namespace
}  // namespace haptic::ipc
