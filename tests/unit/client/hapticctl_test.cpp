// The program itself, as a shell runs it: what it prints and its exit code.

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <stdio.h>
#include <sys/wait.h>

#include <atomic>
#include <thread>

#include "haptic/v1/control.pb.h"
#include "tests/support/places.h"
#include "tests/support/scripted_daemon.h"
#include "tests/support/test_daemon.h"

namespace haptic::cli {
namespace {

struct Finished {
  int code = -1;
  std::string output;  // with errors
};

Finished run(const std::string& arguments) {
  const std::string command = test::hapticctl() + " " + arguments + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  Finished result;
  char chunk[4096];
  while (const std::size_t size = ::fread(chunk, 1, sizeof(chunk), pipe)) {
    result.output.append(chunk, size);
  }
  const int status = ::pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// publishes a tick each millisecond
class Ticker {
 public:
  explicit Ticker(test::FakeServo& servo)
      : thread_([&servo](const std::stop_token& stop) {
          for (std::uint64_t tick = 1; !stop.stop_requested(); ++tick) {
            servo.publish(tick, fill);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}

 private:
  static void fill(servo::Snapshot& snapshot) {
    snapshot.objects.push_back({{0.01, 0, 0}, {1, 0, 0, 0}, {}, {}, {}, {}});
    snapshot.hips.resize(2);
    snapshot.hips[0].force = {0, 0, 1.25};
    servo::DeviceSnapshot device{};
    device.present = true;
    device.position = {0, 0.02, 0};
    snapshot.devices.push_back(device);
  }

  std::jthread thread_;
};

class Hapticctl : public testing::Test {
 protected:
  void serve(ipc::ServerSettings settings = {}) {
    daemon_ = std::make_unique<test::TestDaemon>(std::move(settings));
  }
  Finished ctl(const std::string& arguments) {
    return run("--socket " + daemon_->address() + " " + arguments);
  }

  std::unique_ptr<test::TestDaemon> daemon_;
};

TEST_F(Hapticctl, ExitsWithFiveWhenTheDaemonIsUnreachable) {
  const Finished result = run("status --socket /nowhere/hapticd.sock");
  EXPECT_EQ(result.code, 5);
  EXPECT_EQ(result.output,
            "hapticctl: cannot reach the daemon at /nowhere/hapticd.sock: there is no socket; is hapticd "
            "running?\n");
}

TEST_F(Hapticctl, ExitsWithSixWhenTheDaemonSpeaksAnotherMajorAndTellsBoth) {
  // a daemon says hello before it refuses one, so that the client can tell of both in its own words
  const test::ScriptedDaemon daemon(
      test::hello(2) + test::framed([](v1::Envelope& envelope) {
        envelope.mutable_goodbye()->mutable_error()->set_code(v1::Error::MISMATCH);
        envelope.mutable_goodbye()->mutable_error()->set_message("in the daemon's words");
      }));
  const Finished result = run("status --socket " + daemon.path());
  EXPECT_EQ(result.code, 6);
  EXPECT_EQ(result.output,
            "hapticctl: this program speaks protocol 1.0, the daemon (hapticd 3.0) 2.4; install matching "
            "versions\n");
}

TEST_F(Hapticctl, ExitsWithSixWhenADaemonOfAnotherMajorOnlySaysGoodbye) {
  const test::ScriptedDaemon daemon(test::framed([](v1::Envelope& envelope) {
    envelope.mutable_goodbye()->mutable_error()->set_code(v1::Error::MISMATCH);
    envelope.mutable_goodbye()->mutable_error()->set_message("hapticd 3.0 speaks 2.4, hapticctl 1.0");
  }));
  const Finished result = run("status --socket " + daemon.path());
  EXPECT_EQ(result.code, 6);
  EXPECT_EQ(result.output, "hapticctl: hapticd 3.0 speaks 2.4, hapticctl 1.0\n");
}

TEST_F(Hapticctl, MakesCertificatesWithWhichItIsLetIn) {
  const test::TemporaryFolder folder;
  const std::string lab = folder.file("lab");
  const std::string make = "certificates " + lab + " --server-name 127.0.0.1 --client alice --client bob";
  const Finished made = run(make);
  EXPECT_EQ(made.code, 0) << made.output;
  EXPECT_TRUE(contains(made.output, "allow { name: \"bob\" role: OBSERVE }")) << made.output;
  EXPECT_TRUE(contains(made.output, "key: \"" + lab + "/server.key\"")) << made.output;
  EXPECT_EQ(run(make).code, 1);

  ipc::ServerSettings settings;
  v1::Listen::Tcp& tcp = *settings.listen.emplace_back().mutable_tcp();
  tcp.set_address("127.0.0.1");
  tcp.mutable_tls()->set_certificate(lab + "/server.crt");
  tcp.mutable_tls()->set_key(lab + "/server.key");
  tcp.mutable_tls()->set_authority(lab + "/authority.crt");
  v1::Listen::AllowName& allow = *tcp.add_allow();
  allow.set_name("alice");
  allow.set_role(v1::OBSERVE);
  serve(settings);
  const auto as = [&](const std::string& name, const std::string& verb) {
    return run(verb + " --server " + daemon_->address() + " --certificate " + lab + "/" + name +
               ".crt --key " + lab + "/" + name + ".key --authority " + lab + "/authority.crt");
  };
  EXPECT_EQ(as("alice", "status").code, 0) << as("alice", "status").output;
  EXPECT_EQ(as("alice", "arm").code, 4);
  EXPECT_EQ(as("bob", "status").code, 4);
  EXPECT_EQ(run("status --server nowhere").code, 1);
}

TEST_F(Hapticctl, ExitsWithSixtyFourWhenItIsMisused) {
  for (const char* arguments :
       {"", "frobnicate", "status --nonsense", "step 0", "step -3", "watch --topic smell", "scene",
        "scene load", "watch --rate 0", "watch --rate nan", "latency --seconds nan"}) {
    const Finished result = run(arguments);
    EXPECT_EQ(result.code, 64) << arguments;
    EXPECT_TRUE(contains(result.output, "hapticctl: ")) << result.output;
  }
}

TEST_F(Hapticctl, NamesAVerbThatIsNotThereAndThoseNearToIt) {
  const Finished near = run("stauts --json");
  EXPECT_EQ(near.code, 64);
  EXPECT_EQ(near.output,
            "hapticctl: there is no verb \"stauts\"; did you mean status or stats?; see hapticctl --help\n");
  const Finished far = run("NONSENSE");
  EXPECT_EQ(far.code, 64);
  EXPECT_EQ(far.output, "hapticctl: there is no verb \"NONSENSE\"; see hapticctl --help\n");
  const Finished nested = run("object mvoe box");
  EXPECT_EQ(nested.code, 64);
  EXPECT_EQ(nested.output,
            "hapticctl: there is no verb \"object mvoe\"; did you mean move?; see hapticctl --help\n");
}

TEST_F(Hapticctl, HelpsAndTellsItsVersion) {
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_EQ(run("watch --help").code, 0);
  EXPECT_EQ(run("--version").output, "hapticctl " HAPTIC_VERSION "\n");
}

TEST_F(Hapticctl, ShowsStatus) {
  serve();
  const Finished result = ctl("status");
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(contains(result.output, "disarmed")) << result.output;
  EXPECT_TRUE(contains(result.output, "example (revision 1): 1 object, 1 finger, 2 HIPs")) << result.output;
}

TEST_F(Hapticctl, PrintsStatusAsProtobufJsonInOneLine) {
  serve();
  const Finished result = ctl("status --json");
  EXPECT_EQ(result.code, 0);
  v1::Status status;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(result.output, &status).ok()) << result.output;
  EXPECT_EQ(status.hips(), 2U);
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1);
}

TEST_F(Hapticctl, FindsTheDaemonByItsEnvironment) {
  serve();
  ::setenv("HAPTICD_SOCKET", daemon_->address().c_str(), 1);
  EXPECT_EQ(run("status").code, 0);
  ::unsetenv("HAPTICD_SOCKET");
}

TEST_F(Hapticctl, ArmsOnceAndThenHasNothingToDo) {
  serve();
  EXPECT_EQ(ctl("arm").code, 0);
  const Finished again = ctl("arm");
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.output, "hapticctl: it is armed already\n");
  EXPECT_EQ(ctl("disarm").code, 0);
  EXPECT_EQ(ctl("disarm").code, 2);
}

TEST_F(Hapticctl, PausesStepsAndResumes) {
  serve();
  EXPECT_EQ(ctl("step").code, 2);
  EXPECT_EQ(ctl("pause").code, 0);
  const Finished step = ctl("step 20");
  EXPECT_EQ(step.code, 0);
  EXPECT_EQ(step.output, "ran 20 ticks; paused\n");
  EXPECT_EQ(ctl("resume").code, 0);
}

TEST_F(Hapticctl, ExitsWithFourWhenItIsRefused) {
  serve(test::with_role(v1::OBSERVE));
  const Finished result = ctl("arm");
  EXPECT_EQ(result.code, 4);
  EXPECT_EQ(result.output, "hapticctl: this needs the role DRIVE; yours is OBSERVE\n");
}

TEST_F(Hapticctl, ExitsWithFourWhenItsUserIsRefused) {
  serve(test::with_role(std::nullopt));
  EXPECT_EQ(ctl("status").code, 4);
}

TEST_F(Hapticctl, ExitsWithSevenWhileAFaultIsLatched) {
  serve();
  daemon_->servo().latch({.kind = safety::FaultKind::kOverSpeed, .device = 0, .value = 3, .limit = 2});
  EXPECT_EQ(ctl("arm").code, 7);
  EXPECT_EQ(ctl("clear").code, 0);
  EXPECT_EQ(ctl("clear").code, 2);
  EXPECT_EQ(ctl("arm").code, 0);
}

TEST_F(Hapticctl, StopsInAnEmergencyAndLeavesAFaultToClear) {
  serve();
  EXPECT_EQ(ctl("arm").code, 0);
  const Finished stopped = ctl("estop");
  EXPECT_EQ(stopped.code, 0);
  EXPECT_EQ(stopped.output, "stopped: no device pushes, until somebody clears the fault\n");
  EXPECT_EQ(ctl("arm").code, 7);
  EXPECT_EQ(ctl("estop").code, 0) << "again, to be sure";
  EXPECT_EQ(ctl("clear").code, 0);
  EXPECT_EQ(ctl("arm").code, 0);
}

TEST_F(Hapticctl, ListsDevicesWithTheirFingers) {
  serve();
  const Finished result = ctl("devices");
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(contains(result.output, "left")) << result.output;
  EXPECT_TRUE(contains(result.output, "thumb")) << result.output;
  EXPECT_TRUE(contains(ctl("devices --json").output, R"("driver":"simulated")"));
}

TEST_F(Hapticctl, ShowsAndManagesOneDevice) {
  serve();
  EXPECT_EQ(ctl("devices list").output, ctl("devices").output);
  const Finished shown = ctl("devices show left");
  EXPECT_EQ(shown.code, 0);
  EXPECT_TRUE(contains(shown.output, "simulated")) << shown.output;
  EXPECT_TRUE(contains(ctl("devices show left --json").output, R"("driver":"simulated")"));
  EXPECT_EQ(ctl("devices show nobody").code, 3);
  EXPECT_EQ(ctl("devices reopen nobody").code, 3);
  const Finished refused = ctl("devices reopen left");
  EXPECT_EQ(refused.code, 1);
  EXPECT_TRUE(contains(refused.output, "does not know how to reopen")) << refused.output;
}

TEST_F(Hapticctl, ShowsAndLoadsScenes) {
  serve();
  EXPECT_TRUE(contains(ctl("scene show").output, "block"));
  const Finished bad = ctl("scene load relative.scene.txtpb");
  EXPECT_EQ(bad.code, 1);
  // the daemon is told the whole path, since it runs elsewhere
  EXPECT_TRUE(
      contains(bad.output, "/relative.scene.txtpb:7:3: object[0].shape.box.size.x: 0 is out of range"))
      << bad.output;

  const std::string path = daemon_->folder().write("good.scene.txtpb", "name: \"good\"\n");
  const Finished good = ctl("scene load --send " + path);
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_EQ(good.output, "loaded good (revision 2): 0 objects, 0 fingers, 0 HIPs\n");
  EXPECT_EQ(ctl("scene reset").code, 0);
}

TEST_F(Hapticctl, TellsWhereASceneTextIsWrong) {
  serve();
  EXPECT_EQ(ctl("scene load --send /nowhere.scene.txtpb").code, 3);
  const std::string path = daemon_->folder().write("bad.scene.txtpb", "name: \"bad\"\nobjekt {}\n");
  const Finished bad = ctl("scene load --send " + path);
  EXPECT_EQ(bad.code, 1);
  EXPECT_TRUE(contains(bad.output, "bad.scene.txtpb:2:")) << bad.output;
}

TEST_F(Hapticctl, ShowsObjectsAndFingers) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP()
      << "under ThreadSanitizer protobuf's maps are laid out differently than in the library installed";
#endif
  serve();
  const Ticker ticker(daemon_->servo());
  const Finished objects = ctl("objects");
  EXPECT_EQ(objects.code, 0);
  EXPECT_TRUE(contains(objects.output, "block     +10.00")) << objects.output;
  EXPECT_TRUE(contains(ctl("objects --json").output, R"("position":[0.01,0,0])"));
  const Finished fingers = ctl("fingers");
  EXPECT_EQ(fingers.code, 0);
  EXPECT_TRUE(contains(fingers.output, "1.250")) << fingers.output;
  EXPECT_TRUE(contains(ctl("fingers --json").output, R"("force":[0,0,1.25])"));
}

TEST_F(Hapticctl, WatchesSoManyFramesAndEnds) {
  serve();
  const Ticker ticker(daemon_->servo());
  const Finished lines = ctl("watch --count 3 --rate 100");
  EXPECT_EQ(lines.code, 0);
  EXPECT_EQ(std::count(lines.output.begin(), lines.output.end(), '\n'), 3) << lines.output;

  const Finished json = ctl("watch --json --count 2 --topic objects --rate 100");
  EXPECT_EQ(json.code, 0);
  const std::string first = json.output.substr(0, json.output.find('\n'));
  v1::Frame frame;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(first, &frame).ok()) << first;
  EXPECT_EQ(frame.sequence(), 1U);
  EXPECT_EQ(frame.objects().position_size(), 3);
  EXPECT_FALSE(frame.has_hips());
}

TEST_F(Hapticctl, WatchesForSoLongEvenWhenNothingComes) {
  serve();
  EXPECT_EQ(ctl("watch --seconds 0.1 --json").code, 0);
}

TEST_F(Hapticctl, ShowsTimesAndTransitions) {
  serve();
  auto stats = std::make_unique<servo::LoopStats>();
  stats->stages[static_cast<std::size_t>(servo::Stage::kTick)].record(5000);
  stats->transitions.count[0][1] = 12;
  stats->transitions.timed[0][1] = 2;
  stats->transitions.nanoseconds[0][1] = 1000;
  daemon_->mailbox().stats.write(*stats);
  const Finished result = ctl("stats");
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(contains(result.output, "12 x 500 ns")) << result.output;
  EXPECT_TRUE(contains(result.output, "5.0 us")) << result.output;
  EXPECT_EQ(ctl("stats --reset").code, 0);
  EXPECT_EQ(daemon_->servo().seen(), (std::vector<servo::CommandKind>{servo::CommandKind::kResetStats}));
}

}  // namespace
}  // namespace haptic::cli
