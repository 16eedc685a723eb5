// A bridge between the real server, with a fake servo behind it, and a real nats-server.

#include "client/bridge/bridge.h"

#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "client/lib/certificates.h"
#include "tests/support/nats_server.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/test_daemon.h"

namespace haptic::bridge {
namespace {

using namespace std::chrono_literals;
using test::NatsListener;
using test::NatsServer;
using test::TestDaemon;

bool eventually(const std::function<bool()>& is_true, std::chrono::seconds limit = 20s) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!is_true()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

Options between(const std::string& daemon, const std::string& url) {
  Options options;
  options.daemon.address = daemon;
  options.daemon.timeout = 2s;
  options.broker.urls = {url};
  options.broker.name = "test";
  options.host = "my.lab";
  options.topics = {v1::HIPS, v1::EVENTS};
  options.keep = Keep::kAll;
  return options;
}

void ignore(const std::string& /*line*/) {}

bool is_up(const Bridge& bridge) {
  const v1::BridgeStatus status = bridge.status();
  return status.daemon().connected() && status.broker().connected();
}

// ticks first to last, each with `hips` HIPs at heights of their own; not faster than the daemon takes them
void run_ticks(TestDaemon& daemon, std::uint64_t first, std::uint64_t last, std::size_t hips = 2) {
  for (std::uint64_t tick = first; tick <= last; ++tick) {
    daemon.servo().publish(tick, [tick, hips](servo::Snapshot& snapshot) {
      snapshot.hips.resize(hips, {.position = {0.0, 0.0, static_cast<double>(tick)}, .force = {}});
    });
    std::this_thread::sleep_for(1ms);
  }
}

// without what belongs to one subscription
std::string content(v1::Frame frame) {
  frame.clear_subscription();
  frame.clear_sequence();
  return frame.SerializeAsString();
}

TEST(Bridge, PublishesTheFramesThatTheDaemonSends) {
  TestDaemon daemon;
  const NatsServer server;
  NatsListener listener(server.url());
  const Options options = between(daemon.address(), server.url());
  const Bridge bridge(options, ignore);
  client::Connection direct(options.daemon);
  v1::Subscribe wish;
  wish.add_topic(v1::HIPS);
  wish.set_delivery(v1::LOSSLESS);
  direct.subscribe(wish);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  run_ticks(daemon, 1, 50);
  for (std::uint64_t sequence = 1; sequence <= 50; ++sequence) {
    const auto expected = direct.receive(10s);
    ASSERT_TRUE(expected && expected->has_frame());
    const auto got = listener.next_as<v1::Frame>("haptic.my_lab.hips");
    EXPECT_EQ(got.sequence(), sequence);
    EXPECT_EQ(content(got), content(expected->frame()));
  }
}

TEST(Bridge, GivesEachTopicASubject) {
  TestDaemon daemon;
  const NatsServer server;
  NatsListener hips(server.url());
  NatsListener events(server.url());
  const Bridge bridge(between(daemon.address(), server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  run_ticks(daemon, 1, 1);
  const auto frame = hips.next_as<v1::Frame>("haptic.my_lab.hips");
  EXPECT_TRUE(frame.has_hips());
  EXPECT_FALSE(frame.has_event());
  daemon.servo().miss_ticks(3);
  EXPECT_EQ(events.next_as<v1::Frame>("haptic.my_lab.events").event().kind(), v1::Event::TICKS_MISSED);
}

TEST(Bridge, TellsTheSceneAtTheStartWhenItChangesAndOnRequest) {
  TestDaemon daemon;
  const NatsServer server;
  NatsListener listener(server.url());
  const Options options = between(daemon.address(), server.url());
  const Bridge bridge(options, ignore);
  const auto scene = listener.next_as<v1::SceneDescription>("haptic.my_lab.scene");
  EXPECT_EQ(scene.SerializeAsString(), test::example_scene().SerializeAsString());
  client::Connection direct(options.daemon);
  v1::Request edit;
  edit.mutable_edit_scene()->add_edit()->mutable_set_gravity()->set_y(-2.0);
  const v1::SceneDescription edited = direct.call(edit).scene();
  ASSERT_GT(edited.revision(), scene.revision());
  const auto second = listener.next_as<v1::SceneDescription>("haptic.my_lab.scene");
  EXPECT_EQ(second.SerializeAsString(), edited.SerializeAsString());
  EXPECT_EQ(listener.ask("haptic.my_lab.scene.get"), edited.SerializeAsString());
}

TEST(Bridge, TellsItsStatusByItselfAndOnRequest) {
  TestDaemon daemon;
  const NatsServer server;
  NatsListener listener(server.url());
  const Bridge bridge(between(daemon.address(), server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  run_ticks(daemon, 1, 3);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(listener.next("haptic.my_lab.hips"));
  }
  v1::BridgeStatus status;
  ASSERT_TRUE(status.ParseFromString(listener.ask("haptic.my_lab.status.get")));
  EXPECT_EQ(status.version(), HAPTIC_VERSION);
  EXPECT_EQ(status.daemon().peer(), "hapticd 9.9");
  EXPECT_EQ(status.broker().peer(), server.url());
  ASSERT_EQ(status.flow_size(), 2);
  EXPECT_EQ(status.flow(0).topic(), v1::HIPS);
  EXPECT_EQ(status.flow(0).published(), 3U);
  EXPECT_EQ(status.flow(0).lost(), 0U);
  EXPECT_TRUE(listener.next("haptic.my_lab.status"));
}

TEST(Bridge, ComesBackToABrokerThatWasKilled) {
  TestDaemon daemon;
  NatsServer server;
  const Bridge bridge(between(daemon.address(), server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  server.kill();
  ASSERT_TRUE(eventually([&] { return !bridge.status().broker().connected(); }));
  EXPECT_NE(bridge.status().broker().problem(), "");
  server.start();
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  EXPECT_EQ(bridge.status().broker().connections(), 2U);
  EXPECT_EQ(bridge.status().daemon().connections(), 1U);
  NatsListener listener(server.url());
  run_ticks(daemon, 1, 1);
  EXPECT_EQ(listener.next_as<v1::Frame>("haptic.my_lab.hips").tick(), 1U);
  v1::BridgeStatus status;
  EXPECT_TRUE(status.ParseFromString(listener.ask("haptic.my_lab.status.get")));
}

TEST(Bridge, KeepsWhatItsBufferHoldsWhileThereIsNoBroker) {
  TestDaemon daemon;
  NatsServer server;
  Options options = between(daemon.address(), server.url());
  options.buffer = std::size_t{64} * 1024;
  const Bridge bridge(options, ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  server.kill();
  ASSERT_TRUE(eventually([&] { return !bridge.status().broker().connected(); }));
  // 100 HIPs are some 5 kB: about 13 frames are kept
  run_ticks(daemon, 1, 100, 100);
  ASSERT_TRUE(eventually([&] {
    const v1::BridgeStatus::Flow flow = bridge.status().flow(0);
    return flow.lost() + flow.waiting() == 100;
  }));
  const std::uint64_t lost = bridge.status().flow(0).lost();
  ASSERT_GT(lost, 50U);
  ASSERT_LT(lost, 100U);
  server.start();
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  ASSERT_TRUE(eventually([&] { return bridge.status().flow(0).waiting() == 0; }));
  EXPECT_EQ(bridge.status().flow(0).published(), 100 - lost);
  EXPECT_EQ(bridge.status().flow(0).lost(), lost);
}

TEST(Bridge, PublishesAGapBeforeTheFrameThatFollowsIt) {
  TestDaemon daemon;
  // frames of 100 HIPs, some 5 kB, are more than this broker takes
  test::TemporaryFolder folder;
  const NatsServer server({"-c", folder.write("nats.conf", "max_payload: 2048\n")});
  NatsListener frames(server.url());
  NatsListener gaps(server.url());
  const Bridge bridge(between(daemon.address(), server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  run_ticks(daemon, 1, 2);
  run_ticks(daemon, 3, 6, 100);
  run_ticks(daemon, 7, 7);
  for (const std::uint64_t tick : {1U, 2U, 7U}) {
    EXPECT_EQ(frames.next_as<v1::Frame>("haptic.my_lab.hips").tick(), tick);
  }
  std::uint64_t next = 3;
  while (next < 7) {
    const auto gap = gaps.next_as<v1::Gap>("haptic.my_lab.gap");
    EXPECT_EQ(gap.first_sequence(), next);
    EXPECT_EQ(gap.first_tick(), next);
    next = gap.last_sequence() + 1;
  }
  EXPECT_EQ(next, 7U);
  EXPECT_EQ(bridge.status().broker().connections(), 1U);
}

TEST(Bridge, ComesBackToADaemonThatHasStartedAgain) {
  const test::TemporaryFolder folder;
  ipc::ServerSettings settings;
  settings.listen.emplace_back().mutable_unix()->set_path(folder.file("s"));
  auto daemon = std::make_unique<TestDaemon>(settings);
  const NatsServer server;
  NatsListener listener(server.url());
  const Bridge bridge(between(folder.file("s"), server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  run_ticks(*daemon, 1, 2);
  EXPECT_EQ(listener.next_as<v1::Frame>("haptic.my_lab.hips").sequence(), 1U);
  EXPECT_EQ(listener.next_as<v1::Frame>("haptic.my_lab.hips").sequence(), 2U);
  daemon.reset();
  ASSERT_TRUE(eventually([&] { return !bridge.status().daemon().connected(); }));
  EXPECT_TRUE(bridge.status().broker().connected());
  daemon = std::make_unique<TestDaemon>(settings);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  run_ticks(*daemon, 1, 1);
  EXPECT_EQ(listener.next_as<v1::Frame>("haptic.my_lab.hips").sequence(), 1U);
  EXPECT_EQ(bridge.status().daemon().connections(), 2U);
}

TEST(Bridge, ReadsOnFromTheDaemonWhileTheBrokerIsStalled) {
  TestDaemon daemon;
  const NatsServer server;
  const Bridge bridge(between(daemon.address(), server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  server.stall();
  // 200 kB each: more than sockets and buffers hold. The next only comes when the bridge has read the one
  // before; one may be in the hands of the library
  for (std::uint64_t tick = 1; tick <= 400; ++tick) {
    run_ticks(daemon, tick, tick, 4096);
    ASSERT_TRUE(eventually([&] {
      const v1::BridgeStatus::Flow flow = bridge.status().flow(0);
      return flow.lost() + flow.waiting() + flow.published() + 1 >= tick;
    })) << tick;
  }
  const v1::BridgeStatus::Flow flow = bridge.status().flow(0);
  EXPECT_GT(flow.lost(), 100U);
  EXPECT_LE(flow.waiting() * 196'000, std::size_t{8} * 1024 * 1024);
  EXPECT_EQ(flow.lost_before(), 0U);  // it was never behind, so the daemon dropped nothing
  EXPECT_EQ(bridge.status().daemon().connections(), 1U);
  server.go_on();
  ASSERT_TRUE(eventually([&] { return is_up(bridge) && bridge.status().flow(0).waiting() == 0; }));
  NatsListener listener(server.url());
  run_ticks(daemon, 401, 401);
  // what is still on its way comes before
  while (listener.next_as<v1::Frame>("haptic.my_lab.hips").tick() < 401) {
  }
}

TEST(Bridge, KeepsReadingAndTryingWhenThereIsNoSuchBroker) {
  TestDaemon daemon;
  std::string said;
  Bridge bridge(between(daemon.address(), "nats://host.invalid:4222"),
                [&said](const std::string& line) { said += line + "\n"; });
  ASSERT_TRUE(eventually(
      [&] { return bridge.status().daemon().connected() && !bridge.status().broker().problem().empty(); }));
  run_ticks(daemon, 1, 3);
  EXPECT_TRUE(eventually([&] { return bridge.status().flow(0).waiting() == 3; }));
  bridge.stop();
  EXPECT_NE(said.find("broker: no connection to nats://host.invalid:4222"), std::string::npos) << said;
}

TEST(Bridge, TellsThatThereIsNoDaemon) {
  const NatsServer server;
  NatsListener listener(server.url());
  const Bridge bridge(between("/nowhere/s", server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return bridge.status().broker().connected(); }));
  v1::BridgeStatus status;
  ASSERT_TRUE(eventually([&] {
    return status.ParseFromString(listener.ask("haptic.my_lab.status.get")) &&
           !status.daemon().problem().empty();
  }));
  EXPECT_EQ(status.daemon().problem(),
            "cannot reach the daemon at /nowhere/s: there is no socket; is hapticd running?");
  EXPECT_EQ(listener.ask("haptic.my_lab.scene.get"), "");
}

TEST(Bridge, PublishesAllThatItHasReadBeforeItEnds) {
  TestDaemon daemon;
  const NatsServer server;
  NatsListener frames(server.url());
  NatsListener status(server.url());
  Bridge bridge(between(daemon.address(), server.url()), ignore);
  ASSERT_TRUE(eventually([&] { return is_up(bridge); }));
  run_ticks(daemon, 1, 200, 1000);
  bridge.stop();
  const std::uint64_t published = bridge.status().flow(0).published();
  EXPECT_EQ(bridge.status().flow(0).waiting(), 0U);
  std::uint64_t received = 0;
  for (; received < published; ++received) {
    ASSERT_TRUE(frames.next("haptic.my_lab.hips"));
  }
  v1::BridgeStatus last;
  while (!last.ending()) {
    last = status.next_as<v1::BridgeStatus>("haptic.my_lab.status");
  }
  EXPECT_EQ(last.flow(0).published(), published);
}

TEST(Bridge, TellsThatTheBrokerDoesNotKnowItsUser) {
  TestDaemon daemon;
  const NatsServer server({"--user", "bridge", "--pass", "right"});
  const Bridge wrong(between(daemon.address(), "nats://bridge:wrong@" + server.address()), ignore);
  const Bridge right(between(daemon.address(), "nats://bridge:right@" + server.address()), ignore);
  EXPECT_TRUE(eventually([&] { return is_up(right); }));
  EXPECT_EQ(right.status().broker().peer(), server.url());
  ASSERT_TRUE(eventually([&] { return !wrong.status().broker().problem().empty(); }));
  EXPECT_FALSE(wrong.status().broker().connected());
  EXPECT_NE(wrong.status().broker().problem().find("Authorization"), std::string::npos)
      << wrong.status().broker().problem();
}

class BridgeTls : public testing::Test {
 protected:
  BridgeTls()
      : server_({"--tlsverify", "--tlscert", made("ours/server.crt"), "--tlskey",
                 folder_.file("ours/server.key"), "--tlscacert", folder_.file("ours/authority.crt")}) {}

  std::string made(const std::string& name) {
    client::make_certificates(
        {.folder = folder_.file("ours"), .server_names = {"127.0.0.1"}, .clients = {"bridge"}});
    return folder_.file(name);
  }

  Options options(const std::string& identity, const std::string& authority) const {
    Options out = between(daemon_.address(), server_.url());
    out.broker.certificate = folder_.file(identity + ".crt");
    out.broker.key = folder_.file(identity + ".key");
    out.broker.authority = folder_.file(authority);
    return out;
  }

  test::TemporaryFolder folder_;
  TestDaemon daemon_;
  NatsServer server_;
};

TEST_F(BridgeTls, ConnectsWithACertificate) {
  const Bridge bridge(options("ours/bridge", "ours/authority.crt"), ignore);
  EXPECT_TRUE(eventually([&] { return is_up(bridge); }));
}

TEST_F(BridgeTls, BelievesNoBrokerThatAnotherAuthorityVouchesFor) {
  client::make_certificates(
      {.folder = folder_.file("theirs"), .server_names = {"127.0.0.1"}, .clients = {"bridge"}});
  const Bridge bridge(options("ours/bridge", "theirs/authority.crt"), ignore);
  ASSERT_TRUE(eventually([&] { return !bridge.status().broker().problem().empty(); }));
  EXPECT_FALSE(bridge.status().broker().connected());
}

TEST_F(BridgeTls, BelievesNoBrokerThatIsCertifiedForAnotherHost) {
  Options wish = options("ours/bridge", "ours/authority.crt");
  const std::string address = server_.address();
  wish.broker.urls = {"nats://localhost" + address.substr(address.find(':'))};
  const Bridge bridge(wish, ignore);
  ASSERT_TRUE(eventually([&] { return !bridge.status().broker().problem().empty(); }));
  EXPECT_FALSE(bridge.status().broker().connected());
  EXPECT_NE(bridge.status().broker().problem().find("SSL"), std::string::npos)
      << bridge.status().broker().problem();
}

TEST_F(BridgeTls, RefusesToBeginWithoutItsFiles) {
  EXPECT_THROW(Bridge(options("ours/nobody", "ours/authority.crt"), ignore), BrokerError);
  Options wish = options("ours/bridge", "ours/bridge.key");
  EXPECT_THROW(Bridge(wish, ignore), BrokerError);
}

test::Finished run_bridge(const std::string& arguments) {
  return test::run_program("timeout 10 " + test::haptic_bridge() + " " + arguments);
}

TEST(BridgeProgram, RefusesNonsenseAndNamesTheOption) {
  const test::TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> nonsense = {
      {"--url http://broker", "--url"},
      {"--url nats://broker:99999", "--url"},
      {"--topic weather", "--topic"},
      {"--decimation 0", "--decimation"},
      {"--decimation -3", "--decimation"},
      {"--buffer 12", "--buffer"},
      {"--buffer many", "--buffer"},
      {"--latest --lossless", "--latest excludes --lossless"},
      {"--host=''", "--host"},
      {"--broker-certificate /etc/hostname", "--broker-key"},
      {"--broker-authority /nowhere", "--broker-authority"},
      {"--config /nowhere", "/nowhere"},
      {"--config " + folder.write("a.conf", "decimation = often\n"), "--decimation"},
      {"--config " + folder.write("b.conf", "weather = fine\n"), "weather"},
      {"weather", "weather"},
  };
  for (const auto& [arguments, named] : nonsense) {
    const test::Finished finished = run_bridge(arguments);
    EXPECT_EQ(finished.code, 64) << arguments << ": " << finished.output;
    EXPECT_NE(finished.output.find(named), std::string::npos) << arguments << ": " << finished.output;
  }
}

TEST(BridgeProgram, KeepsPasswordsOutOfWhatItSays) {
  EXPECT_EQ(run_bridge("--url nats://user:secret@broker:0").output.find("secret"), std::string::npos);
}

TEST(BridgeProgram, TakesAConfigAndEndsWellOnSigterm) {
  TestDaemon daemon;
  const NatsServer server;
  NatsListener listener(server.url());
  const std::string config =
      daemon.folder().write("bridge.conf", "url = \"" + server.url() +
                                               "\"\nhost = \"from file\"\ntopic = [\"hips\", \"events\"]\n");
  const std::string said = daemon.folder().file("said");
  const test::Finished finished = test::run_program(
      test::haptic_bridge() + " --config " + config + " --socket " + daemon.address() + " 2> " + said +
      " & for i in $(seq 200); do grep -q broker:.connected " + said + " && grep -q daemon:.connected " +
      said + " && break; sleep 0.1; done; kill -TERM $!; wait $!; code=$?; cat " + said + "; (exit $code)");
  EXPECT_EQ(finished.code, 0) << finished.output;
  EXPECT_TRUE(listener.next("haptic.from_file.scene"));
  EXPECT_NE(finished.output.find("broker: connected to " + server.url()), std::string::npos)
      << finished.output;
}

}  // namespace
}  // namespace haptic::bridge
