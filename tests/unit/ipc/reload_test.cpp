// A server that takes over another config while clients are connected, and one that serves on a socket which
// the service manager opened.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "client/lib/certificates.h"
#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "tests/support/eventually.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using client::Connection;
using test::TestDaemon;

client::Options to(const std::string& address, client::Identity identity = {}) {
  client::Options options;
  options.address = address;
  options.identity = std::move(identity);
  return options;
}

// everything that the caller and its groups decide, as in the service
ServerSettings at(const std::string& path) {
  ServerSettings settings;
  settings.listen.emplace_back().mutable_unix()->set_path(path);
  return settings;
}

v1::Status status_of(Connection& daemon) {
  v1::Request request;
  request.mutable_get_status();
  return daemon.call(request).status();
}

std::string goodbye_to(Connection& client) {
  try {
    while (client.receive(std::chrono::seconds(5))) {
    }
  } catch (const client::Error& error) {
    return error.what();
  }
  return "no goodbye";
}

TEST(Reload, HoldsNewClientsToNewLimits) {
  const test::TemporaryFolder folder;
  ServerSettings settings = at(folder.file("s"));
  TestDaemon daemon(settings);
  Connection first(to(daemon.address()));
  settings.clients_per_user = 1;
  daemon.server().reload(settings);
  EXPECT_TRUE(test::eventually([&] {
    try {
      const Connection second(to(daemon.address()));
      return false;
    } catch (const client::Busy&) {
      return true;
    }
  }));
  EXPECT_EQ(status_of(first).clients(), 1U);  // who was there stays
}

TEST(Reload, CutsOffAClientWhoseRoleHasChangedAndNobodyElse) {
  const test::TemporaryFolder folder;
  std::atomic<bool> demoted{false};
  ServerSettings settings = at(folder.file("s"));
  settings.role_of = [&](const PeerCredentials&) { return demoted ? v1::OBSERVE : v1::DRIVE; };
  TestDaemon daemon(settings);
  Connection client(to(daemon.address()));
  daemon.server().reload(settings);
  EXPECT_EQ(status_of(client).clients(), 1U);

  demoted = true;
  daemon.server().reload(settings);
  EXPECT_EQ(goodbye_to(client), "what you may do has changed; connect again to go on");
  EXPECT_EQ(Connection(to(daemon.address())).daemon().role(), v1::OBSERVE);
}

TEST(Reload, ChangesNothingIfAGroupIsNotThere) {
  const test::TemporaryFolder folder;
  ServerSettings settings = at(folder.file("s"));
  TestDaemon daemon(settings);
  v1::Listen::Allow& allow = *settings.listen[0].mutable_unix()->add_allow();
  allow.set_group("no-such-group");
  allow.set_role(v1::DRIVE);
  settings.clients_per_user = 0;
  EXPECT_THROW(daemon.server().reload(settings), ListenError);
  Connection client(to(daemon.address()));
  EXPECT_EQ(status_of(client).clients(), 1U);
}

class ReloadTls : public testing::Test {
 protected:
  ReloadTls() {
    for (const char* laboratory : {"old", "new"}) {
      client::make_certificates({folder_.file(laboratory), {"127.0.0.1"}, {"alice", "bob"}});
    }
  }

  ServerSettings settings(const std::string& laboratory, const std::vector<std::string>& drivers) const {
    ServerSettings settings;
    v1::Listen::Tcp& tcp = *settings.listen.emplace_back().mutable_tcp();
    tcp.set_address("127.0.0.1");
    tcp.mutable_tls()->set_certificate(folder_.file(laboratory + "/server.crt"));
    tcp.mutable_tls()->set_key(folder_.file(laboratory + "/server.key"));
    tcp.mutable_tls()->set_authority(folder_.file(laboratory + "/authority.crt"));
    for (const std::string& name : drivers) {
      tcp.add_allow()->set_name(name);
      tcp.mutable_allow()->rbegin()->set_role(v1::DRIVE);
    }
    return settings;
  }

  client::Options as(const TestDaemon& daemon, const std::string& laboratory, const std::string& name) const {
    return to(daemon.address(),
              {folder_.file(laboratory + "/" + name + ".crt"), folder_.file(laboratory + "/" + name + ".key"),
               folder_.file(laboratory + "/authority.crt")});
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReloadTls, ShowsTheNewCertificateAndBelievesTheNewAuthority) {
  TestDaemon daemon(settings("old", {"alice"}));
  Connection before(as(daemon, "old", "alice"));
  daemon.server().reload(settings("new", {"alice"}));
  EXPECT_TRUE(test::eventually([&] {
    try {
      return Connection(as(daemon, "new", "alice")).daemon().role() == v1::DRIVE;
    } catch (const client::Unreachable&) {
      return false;
    }
  }));
  EXPECT_THROW(const Connection late(as(daemon, "old", "alice")), client::Unreachable);
  EXPECT_GE(status_of(before).clients(), 1U);  // its connection was made before, and its name may drive
}

TEST_F(ReloadTls, CutsOffANameThatIsStruckOut) {
  TestDaemon daemon(settings("old", {"alice", "bob"}));
  Connection alice(as(daemon, "old", "alice"));
  Connection bob(as(daemon, "old", "bob"));
  daemon.server().reload(settings("old", {"bob"}));
  EXPECT_EQ(goodbye_to(alice), "what you may do has changed; connect again to go on");
  EXPECT_THROW(const Connection again(as(daemon, "old", "alice")), client::Refused);
  EXPECT_GE(status_of(bob).clients(), 1U);
}

TEST_F(ReloadTls, KeepsTheOldCertificateIfTheNewOneIsNoGood) {
  TestDaemon daemon(settings("old", {"alice"}));
  folder_.write("new/server.crt", "no certificate");
  EXPECT_THROW(daemon.server().reload(settings("new", {"alice"})), ListenError);
  EXPECT_EQ(Connection(as(daemon, "old", "alice")).daemon().role(), v1::DRIVE);
}

int listening_socket(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof(name.sun_path) - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  EXPECT_EQ(::listen(socket, 8), 0);
  return socket;
}

TEST(PassedSocket, ServesWhoHasConnectedBeforeTheDaemonCame) {
  const test::TemporaryFolder folder;
  ServerSettings settings = at(folder.file("s"));
  settings.passed_sockets = {listening_socket(folder.file("s"))};
  std::optional<Connection> early;
  std::thread client([&] { early.emplace(to(folder.file("s"))); });  // waits for its hello
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  TestDaemon daemon(settings);
  client.join();
  ASSERT_TRUE(early);
  EXPECT_EQ(status_of(*early).clients(), 1U);
}

TEST(PassedSocket, MustBelongToAListenerOfTheConfig) {
  const test::TemporaryFolder folder;
  ServerSettings settings = at(folder.file("s"));
  settings.passed_sockets = {listening_socket(folder.file("other"))};
  try {
    const TestDaemon daemon(settings);
    FAIL() << "taken";
  } catch (const ListenError& error) {
    EXPECT_EQ(
        std::string(error.what()).rfind("the service manager passes a socket at " + folder.file("other"), 0),
        0U)
        << error.what();
  }
}

}  // namespace
}  // namespace haptic::ipc
