// Several clients at once: frames, events, slow readers, limits, the end.

#include "ipc/server.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "tests/support/eventually.h"
#include "tests/support/raw_client.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using client::Connection;
using test::RawClient;
using test::TestDaemon;

client::Options at(const TestDaemon& daemon) {
  client::Options options;
  options.address = daemon.address();
  return options;
}

v1::Response ask(Connection& daemon, const std::function<void(v1::Request&)>& fill) {
  v1::Request request;
  fill(request);
  return daemon.call(std::move(request));
}

TEST(Server, PublishesToSubscribers) {
  TestDaemon daemon;
  Connection client(at(daemon));
  const std::uint32_t number = client.subscribe({v1::HIPS}, 1);
  daemon.servo().publish(5, [](servo::Snapshot& snapshot) {
    snapshot.hips.push_back({.position = {1, 2, 3}, .force = {0, 0, 4}});
  });
  const auto message = client.receive(std::chrono::seconds(5));
  ASSERT_TRUE(message && message->has_frame());
  EXPECT_EQ(message->frame().subscription(), number);
  EXPECT_EQ(message->frame().sequence(), 1U);
  EXPECT_EQ(message->frame().tick(), 5U);
  EXPECT_EQ(message->frame().hips().force(2), 4.0);
  EXPECT_FALSE(message->frame().has_objects());
}

TEST(Server, EndsASubscription) {
  TestDaemon daemon;
  Connection client(at(daemon));
  const std::uint32_t number = client.subscribe({v1::HIPS}, 1);
  ask(client, [number](v1::Request& request) { request.mutable_unsubscribe()->set_subscription(number); });
  daemon.servo().publish(5);
  EXPECT_FALSE(client.receive(std::chrono::milliseconds(100)));
}

TEST(Server, SendsTheSameBytesToBothOfTwoSubscribers) {
  TestDaemon daemon;
  RawClient first(daemon.address());
  RawClient second(daemon.address());
  std::vector<std::string> bytes;
  for (RawClient* client : {&first, &second}) {
    client->say_hello();
    client->request([](v1::Request& request) {
      request.mutable_subscribe()->add_topic(v1::OBJECTS);
      request.mutable_subscribe()->set_decimation(2);
    });
    ASSERT_TRUE(client->receive()->has_hello());
    ASSERT_TRUE(client->receive()->has_response());
  }
  daemon.servo().publish(2, [](servo::Snapshot& snapshot) {
    snapshot.objects.push_back({{1, 2, 3}, {1, 0, 0, 0}, {}, {}, {}, {}});
  });
  for (RawClient* client : {&first, &second}) {
    const auto message = client->receive_bytes();
    ASSERT_TRUE(message);
    v1::Envelope envelope;
    ASSERT_TRUE(envelope.ParseFromString(*message));
    ASSERT_TRUE(envelope.has_frame());
    envelope.mutable_frame()->clear_subscription();
    bytes.push_back(envelope.SerializeAsString());
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(Server, TellsEveryClientWhatOneDid) {
  TestDaemon daemon;
  Connection actor(at(daemon));
  Connection witness(at(daemon));
  ask(actor, [](v1::Request& request) { request.mutable_arm(); });
  for (Connection* client : {&actor, &witness}) {
    const auto message = client->receive(std::chrono::seconds(5));
    ASSERT_TRUE(message && message->has_event());
    EXPECT_EQ(message->event().kind(), v1::Event::ARMED);
  }
}

TEST(Server, TellsOnceWheneverForceIsAllowedOrForbidden) {
  TestDaemon daemon;
  Connection client(at(daemon));
  std::uint64_t tick = 0;
  const auto becomes = [&](bool armed, int changes) {
    return test::eventually([&] {
      daemon.servo().publish(++tick);
      return daemon.is_armed() == armed && daemon.armed_changes() == changes;
    });
  };
  EXPECT_TRUE(becomes(false, 0));
  ask(client, [](v1::Request& request) { request.mutable_arm(); });
  EXPECT_TRUE(becomes(true, 1));
  ask(client, [](v1::Request& request) { request.mutable_disarm(); });
  EXPECT_TRUE(becomes(false, 2));
}

TEST(Server, AnswersWithTheFaultThatForbidsArming) {
  TestDaemon daemon;
  Connection client(at(daemon));
  const safety::Fault fault{
      .kind = safety::FaultKind::kOverSpeed, .device = 0, .tick = 3, .value = 3.0, .limit = 2.0};
  daemon.servo().latch(fault);
  daemon.servo().publish(4, [&](servo::Snapshot& snapshot) {
    servo::DeviceSnapshot device{};
    device.fault = fault;
    snapshot.devices.push_back(device);
  });
  const auto event = client.receive(std::chrono::seconds(5));
  ASSERT_TRUE(event && event->has_event());
  EXPECT_EQ(event->event().fault().device(), "left");
  // the snapshot may come a poll later than the event
  while (ask(client, [](v1::Request& request) { request.mutable_get_status(); }).status().fault_size() == 0) {
  }
  try {
    ask(client, [](v1::Request& request) { request.mutable_arm(); });
    FAIL() << "armed with a fault";
  } catch (const client::FaultLatched& error) {
    EXPECT_STREQ(error.what(),
                 "a fault is latched (left: over speed, 3 m/s where 2 m/s is allowed); find its cause, then "
                 "clear it");
  }
}

TEST(Server, GivesUpOnAServoThatDoesNotAnswer) {
  ServerSettings settings;
  settings.servo_patience = std::chrono::milliseconds(50);
  TestDaemon daemon(settings);
  daemon.servo().freeze();
  Connection client(at(daemon));
  try {
    ask(client, [](v1::Request& request) { request.mutable_arm(); });
    FAIL() << "got an answer from nobody";
  } catch (const client::Error& error) {
    EXPECT_EQ(error.wire().code(), v1::Error::FAILED);
  }
}

TEST(Server, LoadsASceneAndTellsEverybody) {
  TestDaemon daemon;
  Connection client(at(daemon));
  const v1::Response response = ask(client, [](v1::Request& request) {
    request.mutable_load_scene()->mutable_scene()->set_name("another");
  });
  EXPECT_EQ(response.scene().revision(), 2U);
  const auto event = client.receive(std::chrono::seconds(5));
  ASSERT_TRUE(event && event->has_event());
  EXPECT_EQ(event->event().kind(), v1::Event::SCENE_CHANGED);
  EXPECT_EQ(event->event().scene_revision(), 2U);
  const v1::Response scene = ask(client, [](v1::Request& request) { request.mutable_get_scene(); });
  EXPECT_EQ(scene.scene().scene().name(), "another");
}

TEST(Server, TellsWhereASceneIsWrongAndKeepsTheOldOne) {
  TestDaemon daemon;
  Connection client(at(daemon));
  try {
    ask(client, [](v1::Request& request) { request.mutable_load_scene()->set_path("/scenes/bad.txtpb"); });
    FAIL() << "loaded a bad scene";
  } catch (const client::Invalid& error) {
    EXPECT_STREQ(error.what(), "/scenes/bad.txtpb:7:3: object[0].shape.box.size.x: 0 is out of range");
    EXPECT_EQ(error.wire().line(), 7U);
  }
  const v1::Response scene = ask(client, [](v1::Request& request) { request.mutable_get_scene(); });
  EXPECT_EQ(scene.scene().revision(), 1U);
}

TEST(Server, EditsTheSceneAndTellsEverybody) {
  TestDaemon daemon;
  Connection client(at(daemon));
  const v1::Response response = ask(client, [](v1::Request& request) {
    request.mutable_edit_scene()->set_expected_revision(1);
    request.mutable_edit_scene()->add_edit()->mutable_set_gravity()->set_z(-9.81);
  });
  EXPECT_EQ(response.scene().revision(), 2U);
  EXPECT_EQ(response.scene().scene().name(), "example");
  EXPECT_EQ(response.scene().scene().gravity().z(), -9.81);
  const auto event = client.receive(std::chrono::seconds(5));
  ASSERT_TRUE(event && event->has_event());
  EXPECT_EQ(event->event().kind(), v1::Event::SCENE_CHANGED);
  EXPECT_EQ(event->event().scene_revision(), 2U);
}

TEST(Server, RefusesAnEditOfARevisionThatDoesNotRun) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  client.say_hello();
  ASSERT_TRUE(client.receive());
  client.request([](v1::Request& request) {
    request.set_id(5);
    request.mutable_edit_scene()->set_expected_revision(7);
    request.mutable_edit_scene()->add_edit()->mutable_set_gravity();
  });
  const auto answer = client.receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->response().error().code(), v1::Error::BUSY);
  EXPECT_EQ(answer->response().error().field(), "expected_revision");
}

// frames of 4096 HIPs have about 200 kB: a client that does not read is soon behind
void publish_large(TestDaemon& daemon, std::uint64_t tick) {
  daemon.servo().publish(tick, [](servo::Snapshot& snapshot) { snapshot.hips.resize(4096); });
}

TEST(Server, TellsAStalledClientExactlyWhichFramesItLost) {
  ServerSettings settings;
  settings.session.outbox.data_frames = 4;
  TestDaemon daemon(settings);
  Connection stalled(at(daemon));
  Connection brisk(at(daemon));
  stalled.subscribe({v1::HIPS}, 1);
  brisk.subscribe({v1::HIPS}, 1);

  // the brisk one reads each frame before the next is published, and so loses none
  constexpr std::uint64_t kFrames = 60;
  for (std::uint64_t tick = 1; tick <= kFrames; ++tick) {
    publish_large(daemon, tick);
    const auto message = brisk.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message && message->has_frame()) << tick;
    ASSERT_EQ(message->frame().sequence(), tick);
  }

  // the stalled one accounts for each frame exactly once, as a frame or within a gap
  std::uint64_t next = 1;
  std::uint64_t lost = 0;
  while (next <= kFrames) {
    const auto message = stalled.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message);
    if (message->has_gap()) {
      ASSERT_EQ(message->gap().first_sequence(), next);
      ASSERT_GE(message->gap().last_sequence(), next);
      lost += message->gap().last_sequence() - next + 1;
      next = message->gap().last_sequence() + 1;
    } else {
      ASSERT_EQ(message->frame().sequence(), next);
      ASSERT_EQ(message->frame().tick(), next);
      ++next;
    }
  }
  // the socket's buffers and the queue of 4 hold far fewer than 60 frames of 200 kB
  EXPECT_GT(lost, 40U);
}

TEST(Server, CutsOffAClientWhoseControlOverflows) {
  ServerSettings settings;
  settings.session.outbox.control_bytes = 20'000;
  settings.session.requests_per_second = 10'000'000;  // not what it is cut off for
  TestDaemon daemon(settings);
  RawClient deaf(daemon.address());
  deaf.say_hello();
  // it never reads; what it asks for fills the socket's buffers, then its queue, and then it is out
  Connection witness(at(daemon));
  const auto clients = [&] {
    return ask(witness, [](v1::Request& request) { request.mutable_get_status(); }).status().clients();
  };
  std::string requests;
  for (int i = 0; i < 1000; ++i) {
    v1::Envelope envelope;
    envelope.mutable_request()->mutable_get_scene();
    proto::append_frame(envelope, requests);
  }
  bool cut_off = false;
  for (int round = 0; round < 1000 && !cut_off; ++round) {
    deaf.send(requests);
    cut_off = clients() == 1;
  }
  EXPECT_TRUE(cut_off);
  std::optional<v1::Envelope> last;
  while (auto message = deaf.receive()) {
    last = std::move(message);
  }
  ASSERT_TRUE(last && last->has_goodbye());
  EXPECT_EQ(last->goodbye().error().code(), v1::Error::FAILED);
  EXPECT_EQ(last->goodbye().error().message(),
            "you read too slowly: the answers and events for you overflow");
}

TEST(Server, TakesNoMoreClientsThanItsLimit) {
  ServerSettings settings;
  settings.clients = 2;
  TestDaemon daemon(settings);
  Connection first(at(daemon));
  {
    const Connection second(at(daemon));
    EXPECT_THROW(Connection third(at(daemon)), client::Busy);
  }
  // a place that was left is free again, a little later
  for (int attempt = 0;; ++attempt) {
    try {
      const Connection again(at(daemon));
      break;
    } catch (const client::Busy&) {
      ASSERT_LT(attempt, 1000);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
}

TEST(Server, LetsTcpClientsObserveOnly) {
  ServerSettings settings;
  settings.listen.emplace_back().mutable_tcp()->set_address("127.0.0.1");
  settings.role_of = [](const PeerCredentials&) { return v1::ADMIN; };
  TestDaemon daemon(settings);
  Connection client(at(daemon));
  EXPECT_EQ(client.daemon().role(), v1::OBSERVE);
  ask(client, [](v1::Request& request) { request.mutable_get_status(); });
  EXPECT_THROW(ask(client, [](v1::Request& request) { request.mutable_arm(); }), client::Refused);
  EXPECT_TRUE(daemon.servo().seen().empty());
}

TEST(Server, SaysGoodbyeWhenItStops) {
  TestDaemon daemon;
  Connection client(at(daemon));
  daemon.stop();
  try {
    client.receive(std::chrono::seconds(5));
    FAIL() << "no goodbye";
  } catch (const client::Error& error) {
    EXPECT_STREQ(error.what(), "hapticd stops");
  }
}

TEST(Server, StopsWithAClientThatDoesNotRead) {
  ServerSettings settings;
  settings.session.goodbye = std::chrono::milliseconds(50);
  TestDaemon daemon(settings);
  Connection deaf(at(daemon));
  deaf.subscribe({v1::HIPS}, 1);
  for (std::uint64_t tick = 1; tick < 20; ++tick) {
    publish_large(daemon, tick);
  }
  daemon.stop();
}

}  // namespace
}  // namespace haptic::ipc
