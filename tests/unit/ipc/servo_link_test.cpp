#include "ipc/servo_link.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace haptic::ipc {
namespace {

using std::chrono::milliseconds;

struct Link {
  std::unique_ptr<servo::Mailbox> mailbox = std::make_unique<servo::Mailbox>(servo::Capacity{1, 1, 1, 1, 1});
  std::vector<servo::EventKind> events;
  ServoLink link{*mailbox, milliseconds(100),
                 [this](const servo::Event& event) { events.push_back(event.kind); }};
  SteadyClock::time_point start{};
};

TEST(ServoLink, GivesEachAnswerToTheOneWhoAsked) {
  Link link;
  std::vector<Outcome> first;
  std::vector<Outcome> second;
  link.link.submit({}, link.start, [&](Outcome outcome) { first.push_back(outcome); });
  link.link.submit({}, link.start, [&](Outcome outcome) { second.push_back(outcome); });
  servo::Command command;
  std::vector<std::uint64_t> requests;
  while (link.mailbox->commands.pop(command)) {
    requests.push_back(command.request);
  }
  ASSERT_EQ(requests.size(), 2U);
  link.mailbox->events.push({.kind = servo::EventKind::kFaultRefused, .request = requests[1]});
  link.mailbox->events.push({.kind = servo::EventKind::kDone, .request = requests[0]});
  link.link.poll(link.start);
  EXPECT_EQ(first, (std::vector<Outcome>{Outcome::kDone}));
  EXPECT_EQ(second, (std::vector<Outcome>{Outcome::kFaultRefused}));
}

TEST(ServoLink, GivesUpAfterItsPatienceAndIgnoresALateAnswer) {
  Link link;
  std::vector<Outcome> outcomes;
  link.link.submit({}, link.start, [&](Outcome outcome) { outcomes.push_back(outcome); });
  link.link.poll(link.start + milliseconds(99));
  EXPECT_TRUE(outcomes.empty());
  link.link.poll(link.start + milliseconds(100));
  EXPECT_EQ(outcomes, (std::vector<Outcome>{Outcome::kNoAnswer}));
  link.mailbox->events.push({.kind = servo::EventKind::kDone, .request = 1});
  link.link.poll(link.start + milliseconds(101));
  EXPECT_EQ(outcomes.size(), 1U);
  EXPECT_EQ(link.events.size(), 1U);  // those who follow the servo's state still hear of it
}

TEST(ServoLink, WaitsLongerForACommandThatTakesLonger) {
  Link link;
  std::vector<Outcome> outcomes;
  link.link.submit(
      {}, link.start, [&](Outcome outcome) { outcomes.push_back(outcome); }, milliseconds(500));
  link.link.poll(link.start + milliseconds(599));
  EXPECT_TRUE(outcomes.empty());
  link.link.poll(link.start + milliseconds(600));
  EXPECT_EQ(outcomes.size(), 1U);
}

TEST(ServoLink, FreesARetiredScene) {
  Link link;
  auto scene = std::make_shared<const engine::Scene>();
  const std::weak_ptr<const engine::Scene> watch = scene;
  auto prepared = std::make_unique<servo::PreparedScene>(servo::PreparedScene{
      .revision = 1, .world = engine::World(std::move(scene)), .device_of_finger = {}, .finger_poses = {}});
  link.mailbox->events.push({.kind = servo::EventKind::kSceneRetired, .scene = prepared.release()});
  EXPECT_FALSE(watch.expired());
  link.link.poll(link.start);
  EXPECT_TRUE(watch.expired());
  EXPECT_TRUE(link.events.empty());
}

TEST(ServoLink, RefusesWhatTheQueueHasNoRoomFor) {
  Link link;
  int sent = 0;
  while (sent < 1000 && link.link.submit({}, link.start, [](Outcome) {})) {
    ++sent;
  }
  EXPECT_EQ(sent, 256);
}

}  // namespace
}  // namespace haptic::ipc
