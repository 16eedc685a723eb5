#include "client/lib/connection.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <functional>
#include <thread>

#include "client/lib/error.h"
#include "tests/support/scripted_daemon.h"
#include "tests/support/test_daemon.h"

namespace haptic::client {
namespace {

using std::chrono::milliseconds;
using test::framed;
using test::ScriptedDaemon;

Options at(const std::string& address) {
  Options options;
  options.address = address;
  options.timeout = milliseconds(2000);
  return options;
}

template <class Expected>
std::string message_of(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const Expected& error) {
    return error.what();
  }
  return "no error";
}

v1::Request get_status() {
  v1::Request request;
  request.mutable_get_status();
  return request;
}

TEST(Connection, SaysWhatToDoWhenThereIsNoDaemon) {
  EXPECT_EQ(message_of<Unreachable>([] { const Connection daemon(at("/nowhere/hapticd.sock")); }),
            "cannot reach the daemon at /nowhere/hapticd.sock: there is no socket; is hapticd running?");
}

TEST(Connection, SaysWhatToDoWhenADaemonHasDied) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("dead.sock");
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof(name.sun_path) - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  ::close(socket);
  EXPECT_EQ(message_of<Unreachable>([&] { const Connection daemon(at(path)); }),
            "cannot reach the daemon at " + path + ": nobody listens there; is hapticd running?");
}

TEST(Connection, RefusesADaemonOfAnotherMajorInWords) {
  ScriptedDaemon daemon(test::hello(2));
  EXPECT_EQ(message_of<ProtocolMismatch>([&] { const Connection connection(at(daemon.path())); }),
            "this program speaks protocol 1.0, the daemon (hapticd 3.0) 2.4; install matching versions");
}

TEST(Connection, IsToldByTheDaemonThatItsOwnMajorIsRefused) {
  test::TestDaemon daemon;
  Options options = at(daemon.address());
  options.major = 9;
  EXPECT_EQ(message_of<ProtocolMismatch>([&] { const Connection connection(options); }),
            "this program speaks protocol 9.0, the daemon (hapticd 9.9) 1.0; install matching versions");
}

TEST(Connection, AcceptsANewerMinor) {
  ScriptedDaemon daemon(test::hello(1));
  const Connection connection(at(daemon.path()));
  EXPECT_EQ(connection.daemon().minor(), 4U);
}

TEST(Connection, RefusesWhatIsNoDaemon) {
  ScriptedDaemon daemon("HTTP/1.1 400 Bad Request\r\n\r\n" + std::string(200, ' '));
  const std::string message =
      message_of<Unreachable>([&] { const Connection connection(at(daemon.path())); });
  EXPECT_NE(message.find("is not a hapticd"), std::string::npos) << message;
}

TEST(Connection, GivesUpOnASilentPeer) {
  ScriptedDaemon daemon("");
  Options options = at(daemon.path());
  options.timeout = milliseconds(100);
  const std::string message = message_of<Unreachable>([&] { const Connection connection(options); });
  EXPECT_NE(message.find("did not say hello within 0.1 s"), std::string::npos) << message;
}

TEST(Connection, GivesUpOnACallThatIsNotAnswered) {
  ScriptedDaemon daemon(test::hello(1));
  Options options = at(daemon.path());
  options.timeout = milliseconds(100);
  Connection connection(options);
  const std::string message = message_of<Unreachable>([&] { connection.call(get_status()); });
  EXPECT_NE(message.find("did not answer within 0.1 s"), std::string::npos) << message;
}

TEST(Connection, KeepsWhatArrivesDuringACallForLater) {
  // event, then the answer to request 1, as one stream
  ScriptedDaemon daemon(test::hello(1) +
                        framed([](v1::Envelope& envelope) { envelope.mutable_event()->set_tick(5); }) +
                        framed([](v1::Envelope& envelope) {
                          envelope.mutable_response()->set_id(1);
                          envelope.mutable_response()->mutable_status()->set_tick(6);
                        }));
  Connection connection(at(daemon.path()));
  EXPECT_EQ(connection.call(get_status()).status().tick(), 6U);
  const auto kept = connection.receive(milliseconds(0));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->event().tick(), 5U);
}

TEST(Connection, IgnoresTheAnswerToACallThatItGaveUp) {
  ScriptedDaemon daemon(test::hello(1) +
                        framed([](v1::Envelope& envelope) { envelope.mutable_response()->set_id(77); }) +
                        framed([](v1::Envelope& envelope) {
                          envelope.mutable_response()->set_id(1);
                          envelope.mutable_response()->mutable_done();
                        }));
  Connection connection(at(daemon.path()));
  EXPECT_TRUE(connection.call(get_status()).has_done());
}

TEST(Connection, ThrowsWhyItWasCutOff) {
  ScriptedDaemon daemon(test::hello(1) + framed([](v1::Envelope& envelope) {
                          v1::Error& error = *envelope.mutable_goodbye()->mutable_error();
                          error.set_code(v1::Error::FAILED);
                          error.set_message("you read too slowly");
                        }));
  Connection connection(at(daemon.path()));
  EXPECT_EQ(message_of<Unreachable>([&] { connection.receive(milliseconds(2000)); }), "you read too slowly");
}

TEST(Connection, ReturnsNothingWhenNothingComesInTime) {
  test::TestDaemon daemon;
  Connection connection(at(daemon.address()));
  EXPECT_FALSE(connection.receive(milliseconds(20)));
}

TEST(ThrowError, ThrowsTheTypeOfEachCode) {
  const auto throws = [](v1::Error::Code code) {
    v1::Error error;
    error.set_code(code);
    throw_error(error);
  };
  EXPECT_THROW(throws(v1::Error::NOT_FOUND), NotFound);
  EXPECT_THROW(throws(v1::Error::NOTHING_TO_DO), NothingToDo);
  EXPECT_THROW(throws(v1::Error::REFUSED), Refused);
  EXPECT_THROW(throws(v1::Error::FAULT_LATCHED), FaultLatched);
  EXPECT_THROW(throws(v1::Error::INVALID), Invalid);
  EXPECT_THROW(throws(v1::Error::UNSUPPORTED), Unsupported);
  EXPECT_THROW(throws(v1::Error::MISMATCH), ProtocolMismatch);
  EXPECT_THROW(throws(v1::Error::BUSY), Busy);
  EXPECT_THROW(throws(v1::Error::FAILED), Error);
  EXPECT_THROW(throws(static_cast<v1::Error::Code>(99)), Error);
}

TEST(Error, StandsInOneLineWithItsPlace) {
  v1::Error wire;
  wire.set_message("must be positive");
  EXPECT_STREQ(Error(wire).what(), "must be positive");
  wire.set_field("object[1].name");
  EXPECT_STREQ(Error(wire).what(), "object[1].name: must be positive");
  wire.set_file("a.txtpb");
  EXPECT_STREQ(Error(wire).what(), "a.txtpb: object[1].name: must be positive");
  wire.set_line(3);
  wire.set_column(9);
  EXPECT_STREQ(Error(wire).what(), "a.txtpb:3:9: object[1].name: must be positive");
}

}  // namespace
}  // namespace haptic::client
