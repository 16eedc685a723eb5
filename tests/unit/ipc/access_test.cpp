// Who may do what, through each kind of listener: generated, one test for each listener and role, every call
// of the schema in it. And TLS itself: whom the two sides do not believe.

#include <gtest/gtest.h>

#include "client/lib/certificates.h"
#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "ipc/dispatch.h"
#include "tests/support/raw_client.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using client::Connection;
using client::Identity;
using std::chrono::milliseconds;
using test::TestDaemon;

// the certificates of one laboratory, made once
const test::TemporaryFolder& laboratory() {
  static const test::TemporaryFolder kFolder;
  static const bool kMade = [] {
    client::make_certificates({kFolder.file("lab"),
                               {"localhost", "127.0.0.1"},
                               {"OBSERVE", "SCRIPT", "DRIVE", "ADMIN", "mallory"}});
    client::make_certificates({kFolder.file("elsewhere"), {"localhost"}, {"ADMIN"}});
    client::make_certificates({kFolder.file("misnamed"), {"another.example"}, {}});
    return true;
  }();
  static_cast<void>(kMade);
  return kFolder;
}

std::string file(const std::string& name) { return laboratory().file(name); }

Identity identity(const std::string& name, const std::string& folder = "lab") {
  return {file(folder + "/" + name + ".crt"), file(folder + "/" + name + ".key"), file("lab/authority.crt")};
}

constexpr v1::Role kRoles[] = {v1::OBSERVE, v1::SCRIPT, v1::DRIVE, v1::ADMIN};

ServerSettings encrypted(const std::string& server = "lab/server") {
  ServerSettings settings;
  v1::Listen::Tcp& tcp = *settings.listen.emplace_back().mutable_tcp();
  tcp.set_address("127.0.0.1");
  tcp.mutable_tls()->set_certificate(file(server + ".crt"));
  tcp.mutable_tls()->set_key(file(server + ".key"));
  tcp.mutable_tls()->set_authority(file("lab/authority.crt"));
  for (const v1::Role role : kRoles) {
    v1::Listen::AllowName& allow = *tcp.add_allow();
    allow.set_name(v1::Role_Name(role));
    allow.set_role(role);
  }
  return settings;
}

client::Options to(const TestDaemon& daemon, Identity identity = {}) {
  client::Options options;
  options.address = daemon.address();
  options.identity = std::move(identity);
  return options;
}

template <class Expected>
std::string error_of(const client::Options& options) {
  try {
    const Connection connection(options);
  } catch (const Expected& error) {
    return error.what();
  } catch (const client::Error& error) {
    return std::string("another error: ") + error.what();
  }
  return "no error";
}

v1::Error::Code outcome_of(Connection& daemon, const v1::Request& request) {
  try {
    daemon.call(request);
    return v1::Error::UNSPECIFIED;
  } catch (const client::Error& error) {
    return error.wire().code();
  }
}

enum class Kind { kUnix, kTcp, kTls };

struct Entry {
  Kind kind;
  v1::Role asked;  // what the config gives
  v1::Role given;  // what the client must have
};

std::vector<Entry> all_entries() {
  std::vector<Entry> entries;
  for (const v1::Role role : kRoles) {
    entries.push_back({Kind::kUnix, role, role});
    entries.push_back({Kind::kTcp, role, v1::OBSERVE});
    entries.push_back({Kind::kTls, role, role});
  }
  return entries;
}

class Access : public testing::TestWithParam<Entry> {};

TEST_P(Access, IsExactlyThatOfTheTableOfCalls) {
  const Entry& entry = GetParam();
  ServerSettings settings = entry.kind == Kind::kTls ? encrypted() : ServerSettings();
  if (entry.kind == Kind::kTcp) {
    settings.listen.emplace_back().mutable_tcp()->set_address("127.0.0.1");
  }
  settings.role_of = [&](const PeerCredentials&) { return entry.asked; };
  TestDaemon daemon(settings);
  Connection client(to(daemon, entry.kind == Kind::kTls ? identity(v1::Role_Name(entry.asked)) : Identity()));
  ASSERT_EQ(client.daemon().role(), entry.given);

  const auto* const calls = v1::Request::descriptor()->FindOneofByName("call");
  for (int i = 0; i < calls->field_count(); ++i) {
    v1::Request request;
    request.GetReflection()->MutableMessage(&request, calls->field(i));
    const bool refused = outcome_of(client, request) == v1::Error::REFUSED;
    EXPECT_EQ(refused, entry.given < least_role(request)) << calls->field(i)->name();
  }
}

std::string name_of(const testing::TestParamInfo<Entry>& entry) {
  constexpr const char* kKinds[] = {"Unix", "Tcp", "Tls"};
  return std::string(kKinds[static_cast<int>(entry.param.kind)]) + "_" + v1::Role_Name(entry.param.asked);
}

INSTANTIATE_TEST_SUITE_P(EachListenerAndRole, Access, testing::ValuesIn(all_entries()), name_of);

TEST(TlsAccess, RefusesACertificateWithAnotherNameInWords) {
  TestDaemon daemon(encrypted());
  EXPECT_EQ(
      error_of<client::Refused>(to(daemon, identity("mallory"))),
      "the certificate of \"mallory\" may not use this daemon; its config allows names in listen.tcp.allow");
}

TEST(TlsAccess, LetsNobodyInWithACertificateOfAnotherAuthority) {
  TestDaemon daemon(encrypted());
  // the very name of an administrator
  const std::string error = error_of<client::Unreachable>(to(daemon, identity("ADMIN", "elsewhere")));
  EXPECT_NE(error.find("closed the connection: tlsv1 alert unknown ca"), std::string::npos) << error;
}

TEST(TlsAccess, LetsNobodyInWithTheServersOwnCertificate) {
  ServerSettings settings = encrypted();
  v1::Listen::AllowName& allow = *settings.listen[0].mutable_tcp()->add_allow();
  allow.set_name("localhost");
  allow.set_role(v1::ADMIN);
  TestDaemon daemon(settings);
  EXPECT_NE(error_of<client::Unreachable>(to(daemon, identity("server"))).find("closed"), std::string::npos);
}

TEST(TlsAccess, LetsNobodyInWithoutTls) {
  TestDaemon daemon(encrypted());
  EXPECT_THROW(const Connection client(to(daemon)), client::Unreachable);
}

TEST(TlsAccess, ClientsBelieveNoServerOfAnotherName) {
  TestDaemon daemon(encrypted("misnamed/server"));
  Identity own = identity("ADMIN");
  own.authority = file("misnamed/authority.crt");
  const std::string error = error_of<client::Unreachable>(to(daemon, own));
  EXPECT_EQ(error, "cannot trust the daemon at 127.0.0.1: IP address mismatch");
}

TEST(TlsAccess, ClientsBelieveNoServerOfAnotherAuthority) {
  TestDaemon daemon(encrypted());
  Identity own = identity("ADMIN");
  own.authority = file("elsewhere/authority.crt");
  const std::string error = error_of<client::Unreachable>(to(daemon, own));
  EXPECT_EQ(error.rfind("cannot trust the daemon at 127.0.0.1: ", 0), 0U) << error;
}

TEST(TlsAccess, SaysWhichFileOfTheClientCannotBeUsed) {
  TestDaemon daemon(encrypted());
  Identity none = identity("ADMIN");
  none.key = "/nowhere.key";
  EXPECT_EQ(error_of<client::Invalid>(to(daemon, none)).rfind("cannot use /nowhere.key as the key", 0), 0U);
  none.key.clear();
  EXPECT_EQ(error_of<client::Invalid>(to(daemon, none)),
            "TLS needs a certificate, its key and an authority; the key is missing");
}

TEST(TlsAccess, SaysWhichFileOfTheDaemonCannotBeUsed) {
  ServerSettings settings = encrypted();
  settings.listen[0].mutable_tcp()->mutable_tls()->set_key(file("lab/ADMIN.key"));  // to another certificate
  EXPECT_THROW(TestDaemon daemon(settings), ListenError);
}

TEST(TlsAccess, CarriesFramesAndLongAnswers) {
  TestDaemon daemon(encrypted());
  Connection client(to(daemon, identity("OBSERVE")));
  client.subscribe({v1::HIPS}, 1);
  for (std::uint64_t tick = 1; tick <= 20; ++tick) {
    daemon.servo().publish(tick, [](servo::Snapshot& snapshot) { snapshot.hips.resize(4096); });
    const auto message = client.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message && message->has_frame());
    EXPECT_EQ(message->frame().tick(), tick);
    EXPECT_EQ(message->frame().hips().position_size(), 3 * 4096);
  }
}

TEST(TlsAccess, ASilentHandshakeEndsAndDisturbsNobody) {
  ServerSettings settings = encrypted();
  settings.session.hello = milliseconds(100);
  TestDaemon daemon(settings);
  test::RawClient silent(daemon.address());
  Connection client(to(daemon, identity("OBSERVE")));
  EXPECT_FALSE(silent.receive(milliseconds(3000)));
  EXPECT_TRUE(silent.is_closed());
  v1::Request request;
  request.mutable_get_status();
  EXPECT_EQ(client.call(request).status().clients(), 1U);
}

TEST(TlsAccess, SaysGoodbyeOverTlsToo) {
  TestDaemon daemon(encrypted());
  Connection client(to(daemon, identity("OBSERVE")));
  daemon.stop();
  try {
    client.receive(std::chrono::seconds(5));
    FAIL() << "no goodbye";
  } catch (const client::Error& error) {
    EXPECT_STREQ(error.what(), "hapticd stops");
  }
}

}  // namespace
}  // namespace haptic::ipc
