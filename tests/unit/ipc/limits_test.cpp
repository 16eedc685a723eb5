// How much one client can take of the daemon, and who drives: as clients see it.

#include <gtest/gtest.h>
#include <unistd.h>

#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "ipc/server.h"
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

template <class Expected>
std::string error_of(Connection& daemon, const std::function<void(v1::Request&)>& fill) {
  try {
    ask(daemon, fill);
  } catch (const Expected& error) {
    return error.what();
  }
  return "no error";
}

void arm(v1::Request& request) { request.mutable_arm(); }
void acquire(v1::Request& request) { request.mutable_acquire_drive(); }
void beat(v1::Request& request) { request.mutable_heartbeat(); }
void stop(v1::Request& request) { request.mutable_emergency_stop(); }
void get_status(v1::Request& request) { request.mutable_get_status(); }

// the daemon has noticed that others are gone
void wait_until_alone(Connection& client) {
  while (ask(client, get_status).status().clients() > 1) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

ServerSettings patient_drive() {
  ServerSettings settings;
  settings.drive.longest_silence = std::chrono::seconds(10);
  return settings;
}

TEST(Limits, TakeNoMoreClientsOfOneUser) {
  ServerSettings settings;
  settings.clients_per_user = 2;
  TestDaemon daemon(settings);
  const Connection first(at(daemon));
  const Connection second(at(daemon));
  try {
    const Connection third(at(daemon));
    FAIL() << "taken";
  } catch (const client::Busy& error) {
    EXPECT_STREQ(error.what(), "2 clients of yours are connected, and no more are taken");
  }
}

TEST(Limits, GiveNoMoreSubscriptions) {
  ServerSettings settings;
  settings.session.subscriptions = 2;
  TestDaemon daemon(settings);
  Connection client(at(daemon));
  client.subscribe({v1::HIPS}, 1);
  const std::uint32_t second = client.subscribe({v1::HIPS}, 1);
  EXPECT_THROW(client.subscribe({v1::HIPS}, 1), client::Busy);
  ask(client, [&](v1::Request& request) { request.mutable_unsubscribe()->set_subscription(second); });
  client.subscribe({v1::HIPS}, 1);
}

TEST(Limits, RefuseALongListInAMessageByItsField) {
  ServerSettings settings;
  settings.session.items = 10;
  TestDaemon daemon(settings);
  Connection client(at(daemon));
  const auto load = [](v1::Request& request) {
    v1::Finger& finger = *request.mutable_load_scene()->mutable_scene()->add_finger();
    for (int i = 0; i < 11; ++i) {
      finger.mutable_points()->add_hip();
    }
  };
  EXPECT_EQ(error_of<client::Invalid>(client, load),
            "load_scene.scene.finger[0].points.hip has 11 items; 10 are permitted");
  EXPECT_TRUE(daemon.servo().seen().empty());
}

TEST(Limits, RefuseALongListInAHello) {
  ServerSettings settings;
  settings.session.items = 10;
  TestDaemon daemon(settings);
  RawClient client(daemon.address());
  v1::Envelope hello;
  hello.mutable_hello()->set_major(proto::kProtocolMajor);
  for (int i = 0; i < 11; ++i) {
    hello.mutable_hello()->add_feature("x");
  }
  client.send(hello);
  const auto answer = client.receive();
  ASSERT_TRUE(answer && answer->has_goodbye());
  EXPECT_EQ(answer->goodbye().error().field(), "hello.feature");
}

TEST(Limits, HoldFramesSmallerBeforeHelloThanAfter) {
  ServerSettings settings;
  settings.session.greeting_bytes = 1000;
  settings.session.request_bytes = 5000;
  TestDaemon daemon(settings);
  // a length alone is enough: nothing of that size is waited for or allocated
  RawClient early(daemon.address());
  early.send(std::string("\xe9\x07", 2));  // 1001
  const auto first = early.receive();
  ASSERT_TRUE(first && first->has_goodbye());

  RawClient late(daemon.address());
  late.say_hello();
  ASSERT_TRUE(late.receive()->has_hello());
  late.request([](v1::Request& request) { request.mutable_load_scene()->set_path(std::string(2000, 'x')); });
  EXPECT_TRUE(late.receive()->has_response());
  late.send(std::string("\x89\x27", 2));  // 5001
  const auto second = late.receive();
  ASSERT_TRUE(second && second->has_goodbye());
}

TEST(Limits, AnswerBusyBeyondTheRateButNeverToDisarm) {
  ServerSettings settings;
  settings.session.requests_per_second = 5;
  TestDaemon daemon(settings);
  Connection client(at(daemon));
  ask(client, arm);
  int busy = 0;
  for (int i = 0; i < 8; ++i) {
    busy += error_of<client::Busy>(client, get_status) == "no error" ? 0 : 1;
  }
  EXPECT_GE(busy, 1);
  EXPECT_EQ(error_of<client::Error>(client, [](v1::Request& request) { request.mutable_disarm(); }),
            "no error");
}

TEST(Limits, AnswerAnEmergencyStopWhateverWasAskedBefore) {
  ServerSettings settings;
  settings.session.requests_per_second = 5;
  settings.session.open_requests = 1;
  TestDaemon daemon(settings);
  Connection client(at(daemon));
  for (int i = 0; i < 9; ++i) {
    error_of<client::Busy>(client, get_status);
  }
  EXPECT_EQ(error_of<client::Error>(client, stop), "no error");
  EXPECT_EQ(daemon.servo().seen(), std::vector{servo::CommandKind::kEmergencyStop});
}

TEST(Limits, CutAFloodOffInWords) {
  ServerSettings settings;
  settings.session.requests_per_second = 20;
  TestDaemon daemon(settings);
  RawClient flood(daemon.address());
  flood.say_hello();
  std::string requests;
  for (int i = 0; i < 200; ++i) {
    v1::Envelope envelope;
    get_status(*envelope.mutable_request());
    proto::append_frame(envelope, requests);
  }
  flood.send(requests);
  std::optional<v1::Envelope> last;
  while (auto message = flood.receive()) {
    last = std::move(message);
  }
  EXPECT_TRUE(flood.is_closed());
  ASSERT_TRUE(last && last->has_goodbye());
  EXPECT_EQ(last->goodbye().error().code(), v1::Error::BUSY);
  EXPECT_EQ(last->goodbye().error().message(),
            "you have sent far more than 20 requests in a second, which is all you may");
}

TEST(Drive, ArmingWithoutALeaseOutlivesTheConnection) {
  TestDaemon daemon(patient_drive());
  {
    Connection brief(at(daemon));
    ask(brief, arm);
  }
  Connection client(at(daemon));
  wait_until_alone(client);
  EXPECT_EQ(daemon.servo().seen(), std::vector{servo::CommandKind::kArm});
}

TEST(Drive, WhileOneHoldsTheLeaseOthersCannotArmButCanDisarm) {
  TestDaemon daemon(patient_drive());
  Connection driver(at(daemon));
  Connection other(at(daemon));
  EXPECT_EQ(ask(driver, acquire).drive_lease().heartbeat_ms(), 10'000U);
  const std::string refusal = error_of<client::Refused>(other, arm);
  const std::string holder = "(process " + std::to_string(::getpid()) + ")";
  EXPECT_NE(refusal.find(holder + " holds the drive lease; only its holder can arm"), std::string::npos)
      << refusal;
  EXPECT_NE(error_of<client::Refused>(other, acquire).find("holds the drive lease"), std::string::npos);
  ask(driver, arm);
  ask(other, [](v1::Request& request) { request.mutable_disarm(); });
  ask(driver, [](v1::Request& request) { request.mutable_release_drive(); });
  ask(other, arm);
}

TEST(Drive, WhileOneHoldsTheLeaseAnybodyWhoMayDisarmStopsInAnEmergency) {
  TestDaemon daemon(patient_drive());
  Connection driver(at(daemon));
  Connection other(at(daemon));
  ask(driver, acquire);
  ask(driver, arm);
  ask(other, stop);
  EXPECT_THROW(ask(driver, arm), client::FaultLatched);
  std::optional<v1::Envelope> message;
  do {
    message = driver.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message);
  } while (message->event().kind() != v1::Event::FAULT_LATCHED);
  EXPECT_EQ(message->event().fault().kind(), v1::FAULT_EMERGENCY_STOP);
  EXPECT_EQ(message->event().message(), "fault latched: emergency stop");
}

TEST(Drive, ArmingIsRefusedWithTheDeviceAndTheForceThatWaits) {
  TestDaemon daemon;
  daemon.servo().let_force_wait(servo::WaitingForce{.device = 0, .force = 0.8341, .limit = 0.5});
  Connection client(at(daemon));
  EXPECT_EQ(error_of<client::Error>(client, arm),
            "not armed: left: 0.834 N wait to push on it, where at most 0.5 N may when it is armed "
            "(safety.max_arm_force); take it out of what it touches, then arm again");
  daemon.servo().let_force_wait(std::nullopt);
  EXPECT_EQ(error_of<client::Error>(client, arm), "no error");
}

TEST(Drive, AHolderThatDiesLatchesAFaultOfItsName) {
  TestDaemon daemon(patient_drive());
  Connection witness(at(daemon));
  {
    Connection driver(at(daemon));
    ask(driver, acquire);
    ask(driver, arm);
  }
  std::optional<v1::Envelope> message;
  do {
    message = witness.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message);
  } while (message->event().kind() != v1::Event::FAULT_LATCHED);
  EXPECT_EQ(message->event().fault().kind(), v1::FAULT_LOST_DRIVER);
  EXPECT_EQ(message->event().message(), "fault latched: lost driver");
  EXPECT_THROW(ask(witness, arm), client::FaultLatched);
}

TEST(Drive, AHolderThatFallsSilentLosesItAndIsTold) {
  ServerSettings settings;
  settings.drive.longest_silence = std::chrono::milliseconds(50);
  TestDaemon daemon(settings);
  Connection driver(at(daemon));
  ask(driver, acquire);
  ask(driver, arm);
  std::optional<v1::Envelope> message;
  do {
    message = driver.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message);
  } while (message->event().kind() != v1::Event::FAULT_LATCHED);
  EXPECT_EQ(message->event().fault().kind(), v1::FAULT_LOST_DRIVER);
  EXPECT_EQ(message->event().fault().limit(), 0.05);
  EXPECT_EQ(error_of<client::NotFound>(driver, beat), "you do not hold the drive lease");
}

TEST(Drive, StatusTellsWhoHoldsIt) {
  TestDaemon daemon(patient_drive());
  client::Options options = at(daemon);
  options.program = "pilot\033[2J";  // nothing that a terminal would obey reaches others
  Connection driver(options);
  Connection other(at(daemon));
  EXPECT_FALSE(ask(other, get_status).status().has_drive_holder());
  EXPECT_EQ(driver.acquire_drive(std::chrono::milliseconds(5000)).count(), 5000);
  const v1::Status status = ask(other, get_status).status();
  const std::string process = "(process " + std::to_string(::getpid()) + ")";
  EXPECT_NE(status.drive_holder().client().find(process), std::string::npos);
  EXPECT_EQ(status.drive_holder().program(), "pilot?[2J");
  EXPECT_EQ(status.drive_holder().heartbeat_ms(), 5000U);
  EXPECT_GE(status.drive_holder().silence(), 0.0);
  EXPECT_LT(status.drive_holder().silence(), 5.0);
  driver.release_drive();
  EXPECT_FALSE(ask(other, get_status).status().has_drive_holder());
}

TEST(Drive, LastsWhileItsHolderWaitsForSomethingElse) {
  ServerSettings settings;
  settings.drive.longest_silence = std::chrono::milliseconds(500);
  TestDaemon daemon(settings);
  Connection driver(at(daemon));
  driver.acquire_drive();
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
  while (std::chrono::steady_clock::now() < until) {
    driver.receive(std::chrono::milliseconds(700));  // longer than the silence
  }
  EXPECT_TRUE(driver.holds_drive());
  EXPECT_TRUE(ask(driver, get_status).status().has_drive_holder());
}

TEST(Drive, IsToldAsLostToItsHolderWhereverItWaits) {
  ServerSettings settings;
  settings.drive.longest_silence = std::chrono::milliseconds(50);
  TestDaemon daemon(settings);
  Connection driver(at(daemon));
  driver.acquire_drive();
  Connection witness(at(daemon));
  while (ask(witness, get_status).status().has_drive_holder()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  try {
    driver.receive(std::chrono::seconds(5));
    FAIL() << "not told";
  } catch (const client::Error& error) {
    EXPECT_STREQ(error.what(), "the drive lease is lost: the daemon heard no heartbeat in time");
  }
  EXPECT_FALSE(driver.holds_drive());
}

TEST(Drive, AsksForAHeartbeatThatTheConfigPermits) {
  TestDaemon daemon(patient_drive());
  Connection client(at(daemon));
  const auto acquire_for = [](std::uint32_t time) {
    return [time](v1::Request& request) { request.mutable_acquire_drive()->set_heartbeat_ms(time); };
  };
  EXPECT_EQ(ask(client, acquire_for(5000)).drive_lease().heartbeat_ms(), 5000U);
  EXPECT_EQ(error_of<client::Invalid>(client, acquire_for(10'001)),
            "acquire_drive.heartbeat_ms: 10001 ms are not permitted: from 10 to 10000 ms, which is "
            "drive.heartbeat of "
            "the daemon's config");
  EXPECT_THROW(ask(client, acquire_for(9)), client::Invalid);
}

}  // namespace
}  // namespace haptic::ipc
