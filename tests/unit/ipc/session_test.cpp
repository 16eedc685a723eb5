// One client at the wire: what hello decides, and what becomes of peers that break the rules.

#include "ipc/session.h"

#include <gtest/gtest.h>

#include "tests/support/raw_client.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using test::RawClient;
using test::TestDaemon;
using test::with_role;

// the goodbye that the daemon says next, after which it closes
v1::Error goodbye_of(RawClient& client) {
  while (const auto envelope = client.receive()) {
    if (envelope->has_goodbye()) {
      EXPECT_FALSE(client.receive());
      EXPECT_TRUE(client.is_closed());
      return envelope->goodbye().error();
    }
  }
  return {};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Session, AnswersHelloWithVersionRoleWarningsAndScene) {
  TestDaemon daemon(with_role(v1::SCRIPT));
  RawClient client(daemon.address());
  client.say_hello();
  const auto envelope = client.receive();
  ASSERT_TRUE(envelope);
  EXPECT_EQ(envelope->hello().major(), proto::kProtocolMajor);
  EXPECT_EQ(envelope->hello().program(), "hapticd");
  EXPECT_EQ(envelope->hello().version(), "9.9");
  EXPECT_EQ(envelope->hello().role(), v1::SCRIPT);
  EXPECT_EQ(envelope->hello().warning_size(), 1);
  EXPECT_EQ(envelope->hello().scene_revision(), 1U);
}

TEST(Session, TellsBothVersionsOnAMismatch) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  client.say_hello(2);
  const auto hello = client.receive();
  ASSERT_TRUE(hello);
  EXPECT_EQ(hello->hello().major(), 1U);  // so that the client can say it in its own words
  const v1::Error error = goodbye_of(client);
  EXPECT_EQ(error.code(), v1::Error::MISMATCH);
  EXPECT_EQ(error.message(),
            "hapticd 9.9 speaks protocol 1.0, raw 0.0 speaks 2.7; install matching versions");
}

TEST(Session, RefusesInWordsWhoHasNoRole) {
  TestDaemon daemon(with_role(std::nullopt));
  RawClient client(daemon.address());
  client.say_hello();
  EXPECT_EQ(goodbye_of(client).code(), v1::Error::REFUSED);
}

TEST(Session, CutsOffAClientThatSaysNoHello) {
  ServerSettings settings;
  settings.session.hello = std::chrono::milliseconds(50);
  TestDaemon daemon(settings);
  RawClient silent(daemon.address());
  const v1::Error error = goodbye_of(silent);
  EXPECT_EQ(error.code(), v1::Error::INVALID);
  EXPECT_TRUE(contains(error.message(), "no hello"));
}

TEST(Session, CutsOffAClientThatSaysHelloByteByByteTooSlowly) {
  ServerSettings settings;
  settings.session.hello = std::chrono::milliseconds(50);
  TestDaemon daemon(settings);
  RawClient slow(daemon.address());
  slow.send(std::string("\x20"));  // 32 bytes are to follow
  EXPECT_TRUE(contains(goodbye_of(slow).message(), "no hello"));
}

TEST(Session, KeepsAClientThatSaidHelloInTime) {
  ServerSettings settings;
  settings.session.hello = std::chrono::milliseconds(50);
  TestDaemon daemon(settings);
  RawClient client(daemon.address());
  client.say_hello();
  ASSERT_TRUE(client.receive());
  EXPECT_FALSE(client.receive(std::chrono::milliseconds(150)));
  EXPECT_FALSE(client.is_closed());
}

TEST(Session, CutsOffWhoSendsGarbage) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  client.send("GET / HTTP/1.1\r\nHost: hapticd\r\n\r\n" + std::string(100, 'x'));
  EXPECT_EQ(goodbye_of(client).code(), v1::Error::INVALID);
}

TEST(Session, CutsOffWhoSendsARequestBeforeHello) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  client.request([](v1::Request& request) { request.mutable_arm(); });
  EXPECT_TRUE(contains(goodbye_of(client).message(), "must be hello"));
  EXPECT_TRUE(daemon.servo().seen().empty());
}

TEST(Session, RefusesALargeMessageBeforeHelloWithoutWaitingForIt) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  std::string header;
  proto::append_varint(65537, header);
  client.send(header);
  const v1::Error error = goodbye_of(client);
  EXPECT_EQ(error.message(), "a message of 65537 bytes is announced; at most 65536 are accepted");
}

TEST(Session, AcceptsLargerMessagesAfterHelloUpToTheirLimit) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  client.say_hello();
  ASSERT_TRUE(client.receive());
  client.request([](v1::Request& request) {
    request.set_id(1);
    request.mutable_load_scene()->mutable_scene()->set_name(std::string(500'000, 'x'));
  });
  const auto answer = client.receive();
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->goodbye().has_error());

  std::string header;
  proto::append_varint(1024 * 1024 + 1, header);
  client.send(header);
  EXPECT_EQ(goodbye_of(client).message(),
            "a message of 1048577 bytes is announced; at most 1048576 are accepted");
}

TEST(Session, CutsOffWhoSendsAnythingButRequestsAfterHello) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  client.say_hello();
  client.say_hello();
  EXPECT_TRUE(contains(goodbye_of(client).message(), "requests only"));
}

TEST(Session, IgnoresMessagesThatItDoesNotKnow) {
  TestDaemon daemon;
  RawClient client(daemon.address());
  client.say_hello();
  client.send(std::string("\x05\xfa\x07\x02hi", 6));  // field 127 of a newer envelope
  client.request([](v1::Request& request) {
    request.set_id(3);
    request.mutable_get_status();
  });
  ASSERT_TRUE(client.receive()->has_hello());
  const auto answer = client.receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->response().id(), 3U);
}

TEST(Session, SaysBusyBeyondItsOpenRequests) {
  ServerSettings settings;
  settings.session.open_requests = 2;
  TestDaemon daemon(settings);
  daemon.servo().freeze();
  RawClient client(daemon.address());
  client.say_hello();
  for (std::uint64_t id = 1; id <= 3; ++id) {
    client.request([id](v1::Request& request) {
      request.set_id(id);
      request.mutable_disarm();
    });
  }
  ASSERT_TRUE(client.receive()->has_hello());
  const auto answer = client.receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->response().id(), 3U);
  EXPECT_EQ(answer->response().error().code(), v1::Error::BUSY);
}

TEST(Session, SurvivesAThousandBrokenPeers) {
  TestDaemon daemon;
  for (int i = 0; i < 1000; ++i) {
    RawClient client(daemon.address());
    client.send(std::string(static_cast<std::size_t>(i % 7), static_cast<char>(i)));
  }
  RawClient client(daemon.address());
  client.say_hello();
  EXPECT_TRUE(client.receive());
}

}  // namespace
}  // namespace haptic::ipc
