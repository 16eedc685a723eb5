#include <gtest/gtest.h>

#include <thread>

#include "rt/allocation_guard.h"
#include "servo/mailbox.h"

namespace haptic::servo {
namespace {

constexpr Capacity kSmall{.objects = 2, .fingers = 2, .hips = 4, .contacts = 4, .devices = 2};

void publish(SnapshotRing& ring, std::uint64_t tick) {
  ring.writable().tick = tick;
  ring.publish();
}

TEST(SnapshotRing, IsEmptyAtFirst) {
  SnapshotRing ring(kSmall);
  EXPECT_EQ(ring.take(), nullptr);
}

TEST(SnapshotRing, GivesEverySnapshotOnceAndInOrder) {
  SnapshotRing ring(kSmall);
  std::uint64_t next = 0;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    publish(ring, tick);
    if (tick % 3 != 0) continue;
    while (const Snapshot* snapshot = ring.take()) EXPECT_EQ(snapshot->tick, next++);
    EXPECT_EQ(next, tick + 1);
  }
  EXPECT_EQ(ring.lost(), 0u);
}

TEST(SnapshotRing, ASlowReaderLosesTheOldestAndTheLossIsCounted) {
  SnapshotRing ring(kSmall);
  constexpr std::uint64_t kPublished = 10 * SnapshotRing::kSlots + 7;
  for (std::uint64_t tick = 0; tick < kPublished; ++tick) publish(ring, tick);
  EXPECT_EQ(ring.lost(), kPublished - SnapshotRing::kSlots);
  std::uint64_t next = kPublished - SnapshotRing::kSlots;
  while (const Snapshot* snapshot = ring.take()) EXPECT_EQ(snapshot->tick, next++);
  EXPECT_EQ(next, kPublished);
}

TEST(SnapshotRing, WhatTheReaderHoldsStaysAsItIsWhileTheWriterComesRound) {
  SnapshotRing ring(kSmall);
  publish(ring, 77);
  const Snapshot* held = ring.take();
  ASSERT_NE(held, nullptr);
  for (std::uint64_t tick = 100; tick < 100 + 5 * SnapshotRing::kSlots; ++tick) publish(ring, tick);
  EXPECT_EQ(held->tick, 77u);
}

TEST(SnapshotRing, TheBufferToFillIsEmptyAndHasItsCapacity) {
  SnapshotRing ring(kSmall);
  for (std::uint64_t tick = 0; tick < 3 * SnapshotRing::kSlots; ++tick) {
    Snapshot& snapshot = ring.writable();
    EXPECT_TRUE(snapshot.objects.empty() && snapshot.hips.empty() && snapshot.contacts.empty() &&
                snapshot.devices.empty());
    EXPECT_GE(snapshot.hips.capacity(), kSmall.hips);
    snapshot.hips.resize(kSmall.hips);
    snapshot.devices.resize(kSmall.devices);
    publish(ring, tick);
    if (tick % 5 == 0) ring.take();
  }
}

TEST(SnapshotRing, IsRealTimeSafeOnBothSides) {
  SnapshotRing ring(kSmall);
  const rt::AllocationGuard watch;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    publish(ring, tick);
    if (tick % 2 == 0) ring.take();
    if (tick % 300 == 0) {
      while (ring.take() != nullptr) {
      }
    }
  }
}

// Each snapshot carries its tick in every HIP, so that one that is written while it is read would show. What
// is read and what is lost add up to what was published.
TEST(SnapshotRing, NeverTearsNorGoesBackNorLosesCountBetweenTwoThreads) {
  SnapshotRing ring(kSmall);
  constexpr std::uint64_t kPublished = 200000;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t tick = 0; tick < kPublished; ++tick) {
      Snapshot& snapshot = ring.writable();
      for (int i = 0; i < 4; ++i) {
        snapshot.hips.push_back({.position = glm::dvec3(static_cast<double>(tick)), .force = {}});
      }
      publish(ring, tick);
    }
    done = true;
  });
  std::uint64_t read = 0;
  std::uint64_t next = 0;
  for (bool last_round = false;;) {
    const Snapshot* snapshot = ring.take();
    if (snapshot == nullptr) {
      if (last_round) break;
      last_round = done;
      std::this_thread::yield();
      continue;
    }
    ASSERT_GE(snapshot->tick, next);
    next = snapshot->tick + 1;
    ++read;
    ASSERT_EQ(snapshot->hips.size(), 4u);
    for (const HipSnapshot& hip : snapshot->hips) {
      ASSERT_EQ(hip.position.z, static_cast<double>(snapshot->tick));
    }
    // a reader that is slow now and then
    if (read % 1000 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  writer.join();
  EXPECT_EQ(next, kPublished);
  // what the writer overtook while the reader was taking one is counted when the writer comes round again
  for (std::uint64_t i = 0; i < SnapshotRing::kSlots; ++i) publish(ring, kPublished + i);
  EXPECT_EQ(read + ring.lost(), kPublished);
}

}  // namespace
}  // namespace haptic::servo
