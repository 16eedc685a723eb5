#include "ipc/flight_recorder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <memory>

#include "client/lib/connection.h"
#include "engine/shapes.h"
#include "proto/recording/recording.h"
#include "tests/support/eventually.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

engine::Scene scene_of(std::size_t hips) {
  engine::Scene scene;
  scene.objects.resize(2);
  scene.hip_count = hips;
  return scene;
}

const FlightSettings kHere{.directory = "here"};

TEST(FlightPlan, KeepsEverythingOfAnOrdinaryScene) {
  const FlightPlan plan = plan_flight(kHere, 1000.0, 2, scene_of(22));
  EXPECT_EQ(plan.topics, kTickTopics);
  EXPECT_EQ(plan.seconds, 2.0);
  EXPECT_TRUE(plan.keeps_states);
  EXPECT_LT(plan.bytes, kHere.bytes);
}

// 2000 HIPs of some 100 bytes, 1000 times in a second, for 2 s and what goes beside: far more than 64 MiB
TEST(FlightPlan, LeavesOutTheHipsOfALargeSceneButNeverItsInputs) {
  const FlightPlan plan = plan_flight(kHere, 1000.0, 2, scene_of(2000));
  EXPECT_EQ(plan.topics, kTickTopics & ~topic_bit(v1::HIPS));
  EXPECT_EQ(plan.seconds, 2.0);
  engine::Scene many = scene_of(2000);
  many.objects.resize(1000);
  EXPECT_EQ(plan_flight(kHere, 1000.0, 2, many).topics, topic_bit(v1::INPUTS) | topic_bit(v1::DEVICES));
}

TEST(FlightPlan, TellsWhenTheMemoryIsTooSmallForAllSeconds) {
  FlightSettings settings = kHere;
  settings.seconds = 60.0;
  settings.bytes = std::size_t{1} << 20U;
  const FlightPlan plan = plan_flight(settings, 1000.0, 2, scene_of(22));
  EXPECT_LT(plan.seconds, 60.0);
  EXPECT_LE(plan.bytes, settings.bytes);
}

TEST(FlightPlan, LeavesOutStatesThatWouldFillTheMemory) {
  engine::Scene scene = scene_of(16384);
  scene.objects.resize(100);
  EXPECT_FALSE(plan_flight(kHere, 1000.0, 2, scene).keeps_states);
}

/// The real server with a recorder, and a servo whose ticks and faults the test makes.
class Flying : public testing::Test {
 protected:
  void SetUp() override { serve(folder_.file("faults")); }

  void serve(const std::string& directory) {
    ServerSettings settings;
    settings.flight.directory = directory;
    daemon_ = std::make_unique<test::TestDaemon>(std::move(settings));
    client::Options options;
    options.address = daemon_->address();
    connection_ = std::make_unique<client::Connection>(options);
    ticking_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        daemon_->servo().publish(++tick_);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }

  void TearDown() override { end(); }

  void end() {
    ticking_ = {};
    connection_.reset();
    daemon_.reset();
  }

  void latch(safety::FaultKind kind) {
    daemon_->servo().latch({.kind = kind, .device = 0, .tick = tick_, .value = 3.0, .limit = 2.0});
  }

  v1::FaultList faults() {
    v1::Request request;
    request.mutable_list_faults();
    return connection_->call(std::move(request)).faults();
  }

  /// The path that the event tells; empty if none comes.
  std::string recorded() {
    std::string path;
    test::eventually([&] {
      const auto message = connection_->receive(std::chrono::milliseconds(10));
      if (message && message->event().kind() == v1::Event::FAULT_RECORDED)
        path = message->event().recording();
      return !path.empty();
    });
    return path;
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<test::TestDaemon> daemon_;
  std::unique_ptr<client::Connection> connection_;
  std::atomic<std::uint64_t> tick_{0};
  std::jthread ticking_;
};

TEST_F(Flying, AFaultIsRecordedWithWhatCameBeforeAndAfterIt) {
  ASSERT_TRUE(test::eventually([&] { return tick_ > 300; }));
  latch(safety::FaultKind::kOverSpeed);
  const std::string path = recorded();
  ASSERT_NE(path, "");
  ASSERT_EQ(faults().fault_size(), 1);
  const v1::FaultList::FaultRecord record = faults().fault(0);
  EXPECT_EQ(record.recording(), path);
  EXPECT_EQ(record.fault().device(), "left");
  EXPECT_TRUE(record.latched());

  const recording::FileSource source(path);
  const recording::Recording recording(source);
  std::uint64_t first = ~std::uint64_t{0};
  std::uint64_t last = 0;
  for (auto messages = recording.messages({.topics = {recording::channel_of(v1::INPUTS)}});
       messages.next();) {
    v1::Frame frame;
    messages.parse(frame);
    first = std::min(first, frame.tick());
    last = std::max(last, frame.tick());
  }
  EXPECT_LT(first + 200, record.fault().tick());
  EXPECT_GT(last, record.fault().tick());
  auto events = recording.messages({.topics = {recording::channel_of(v1::EVENTS)}});
  ASSERT_TRUE(events.next());
  v1::Frame frame;
  events.parse(frame);
  EXPECT_EQ(frame.event().kind(), v1::Event::FAULT_LATCHED);
}

TEST_F(Flying, AFaultRightAfterAnotherIsInItsFile) {
  latch(safety::FaultKind::kOverSpeed);
  latch(safety::FaultKind::kStaleSample);
  const std::string path = recorded();
  ASSERT_NE(path, "");
  EXPECT_NE(path.find("over_speed"), std::string::npos);
  const v1::FaultList list = faults();
  ASSERT_EQ(list.fault_size(), 2);
  EXPECT_EQ(list.fault(0).recording(), path);
  EXPECT_EQ(list.fault(1).recording(), path);
}

TEST_F(Flying, FaultsOneAfterTheOtherHaveAFileEach) {
  latch(safety::FaultKind::kOverSpeed);
  const std::string first = recorded();
  latch(safety::FaultKind::kStaleSample);
  const std::string second = recorded();
  EXPECT_NE(first, "");
  EXPECT_NE(second, "");
  EXPECT_NE(first, second);
}

TEST_F(Flying, WhatIsClearedIsNoLongerLatched) {
  latch(safety::FaultKind::kOverSpeed);
  ASSERT_TRUE(test::eventually([&] { return faults().fault_size() == 1; }));
  v1::Request request;
  request.mutable_clear_fault();
  connection_->call(std::move(request));
  EXPECT_FALSE(faults().fault(0).latched());
}

TEST_F(Flying, AFaultJustBeforeTheEndIsRecorded) {
  ASSERT_TRUE(test::eventually([&] { return tick_ > 10; }));
  latch(safety::FaultKind::kOverSpeed);
  ASSERT_TRUE(test::eventually([&] { return faults().fault_size() == 1; }));
  end();
  const std::filesystem::directory_iterator first(folder_.file("faults"));
  EXPECT_EQ(first->path().extension(), ".mcap");
}

TEST_F(Flying, WhereNothingCanBeWrittenTheDaemonGoesOnServing) {
  end();
  serve(folder_.file("no/such/place"));
  latch(safety::FaultKind::kOverSpeed);
  const std::uint64_t start = tick_;
  ASSERT_TRUE(test::eventually([&] { return tick_ > start + 600; }));
  ASSERT_EQ(faults().fault_size(), 1);
  EXPECT_EQ(faults().fault(0).recording(), "");
}

}  // namespace
}  // namespace haptic::ipc
