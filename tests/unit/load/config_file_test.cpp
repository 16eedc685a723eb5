#include "load/config_file.h"

#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

LoadedConfig config_of(const std::string& text) {
  v1::DaemonConfig message;
  const TextSource source = parse_message(text, "/c/hapticd.txtpb", Syntax::kText, message);
  return check_config(message, source, "/c/hapticd.txtpb");
}

LoadError error_in(const std::string& text) {
  return error_of([&] { config_of(text); });
}

TEST(Config, LeftEmptyHasEveryDefaultOfTheSchema) {
  const v1::DaemonConfig config = config_of("").message;
  EXPECT_EQ(config.servo().rate_hz(), 1000.0);
  EXPECT_EQ(config.servo().priority(), 80U);
  EXPECT_FALSE(config.servo().has_cpu());
  EXPECT_FALSE(config.servo().lock_memory());
  EXPECT_EQ(config.capacity().objects(), 256U);
  EXPECT_EQ(config.capacity().fingers(), 64U);
  EXPECT_EQ(config.capacity().hips(), 16384U);
  EXPECT_EQ(config.safety().max_force(), 5.0);
  EXPECT_EQ(config.safety().max_force_rate(), 500.0);
  EXPECT_EQ(config.safety().max_speed(), 2.0);
  EXPECT_EQ(config.safety().arm_ramp(), 0.5);
  EXPECT_EQ(config.safety().max_sample_age(), 0.02);
  EXPECT_EQ(config.safety().max_missed_ticks(), 50U);
  EXPECT_EQ(config.listen_size(), 0);
  EXPECT_EQ(config.scene(), "");
  EXPECT_EQ(config.flight_recorder().directory(), "");
  EXPECT_EQ(config.flight_recorder().seconds(), 2.0);
  EXPECT_EQ(config.flight_recorder().keep(), 20U);
  EXPECT_EQ(config.log().level(), v1::Log::INFO);
  EXPECT_EQ(config.log().file(), "");
  EXPECT_EQ(config.log().file_bytes(), 10'000'000U);
  EXPECT_EQ(config.metrics().port(), 0U);
}

TEST(Config, KeepsWhatIsGiven) {
  const v1::DaemonConfig config =
      config_of("servo { rate_hz: 4000 cpu: 0 } safety { max_force: 2.5 }").message;
  EXPECT_EQ(config.servo().rate_hz(), 4000.0);
  EXPECT_TRUE(config.servo().has_cpu());
  EXPECT_EQ(config.safety().max_force(), 2.5);
}

TEST(Config, AcceptsTheEndsOfARangeAndRefusesWhatIsBeyond) {
  EXPECT_EQ(config_of("servo { rate_hz: 100 priority: 1 }").message.servo().priority(), 1U);
  EXPECT_EQ(config_of("servo { rate_hz: 8000 priority: 99 }").message.servo().rate_hz(), 8000.0);
  EXPECT_STREQ(error_in("servo {\n  rate_hz: 8000.5\n}").what(),
               "/c/hapticd.txtpb:2:3: servo.rate_hz: 8000.5 is out of range (permitted: 100 to 8000 Hz)");
  EXPECT_STREQ(
      error_in("safety { max_force: -1 }").what(),
      "/c/hapticd.txtpb:1:10: safety.max_force: -1 is out of range (permitted: more than 0, up to 1000 N)");
}

TEST(Config, TakesPathsRelativeToItself) {
  const v1::DaemonConfig config =
      config_of("scene: \"scenes/a\" listen { unix { path: \"../s\" } } listen { unix { path: \"/t\" } }")
          .message;
  EXPECT_EQ(config.scene(), "/c/scenes/a");
  EXPECT_EQ(config.listen(0).unix().path(), "/s");
  EXPECT_EQ(config.listen(1).unix().path(), "/t");
}

TEST(Config, ReadsThePathsOfItsDevices) {
  const TemporaryFolder folder;
  folder.write("p.csv", "time,x,y,z\n0,0,0,0\n1,2,3,4\n");
  const LoadedConfig config = load_config(folder.write(
      "c.txtpb",
      "device { name: \"a\" simulated { mass: 1 } } device { name: \"b\" playback { path: \"p.csv\" } }"));
  ASSERT_EQ(config.paths.size(), 2U);
  EXPECT_TRUE(config.paths[0].empty());
  EXPECT_EQ(config.paths[1][1].position, glm::dvec3(2.0, 3.0, 4.0));
}

TEST(Config, TellsTheLineOfAPathThatIsWrong) {
  const TemporaryFolder folder;
  const auto path = folder.write("p.csv", "time,x,y,z\n0,0,0,zero\n");
  const auto config = folder.write("c.txtpb", "device { name: \"b\" playback { path: \"p.csv\" } }");
  const LoadError wrong = error_of([&] { load_config(config); });
  EXPECT_EQ(wrong.file(), path.string());
  EXPECT_EQ(wrong.line(), 2U);
  std::filesystem::remove(path);
  const LoadError missing = error_of([&] { load_config(config); });
  EXPECT_EQ(missing.file(), config.string());
  EXPECT_EQ(missing.field(), "device[0].playback.path");
}

TEST(Config, RefusesASecondDeviceOfTheSameName) {
  EXPECT_STREQ(
      error_in("device { name: \"d\" simulated { mass: 1 } }\ndevice { name: \"d\" simulated { mass: 1 } }")
          .what(),
      "/c/hapticd.txtpb:2:10: device[1].name: \"d\" is also the name of device[0]");
}

TEST(Config, FillsInWhatADeviceThatOthersServeIs) {
  const LoadedConfig config = config_of(
      "device { name: \"mouse\" virtual {} }\n"
      "device { name: \"omega\" external { path: \"s/omega.sock\" user: \"lab\" } base { position { y: 1 } } "
      "}");
  ASSERT_EQ(config.paths.size(), 2U);
  const v1::Device::External& external = config.message.device(1).external();
  EXPECT_EQ(external.path(), "/c/s/omega.sock");
  EXPECT_EQ(external.user(0), "lab");
}

TEST(Config, TellsWhatIsWrongWithADeviceThatOthersServe) {
  EXPECT_EQ(error_in("device { name: \"a\" virtual {} base { position { x: 1 } } }").field(),
            "device[0].base");
  EXPECT_EQ(error_in("device { name: \"a\" external {} }").field(), "device[0].external.path");
  EXPECT_EQ(error_in("device { name: \"a\" external { path: \"" + std::string(120, 'a') + "\" } }").field(),
            "device[0].external.path");
  EXPECT_EQ(error_in("device { name: \"a\" external { path: \"s\" max_force: -1 } }").field(),
            "device[0].external.max_force");
  EXPECT_EQ(error_in("device { name: \"a\" external { path: \"s\" user: \"\" } }").field(),
            "device[0].external.user[0]");
  EXPECT_STREQ(
      error_in("device { name: \"a\" external { path: \"s\" } }\n"
               "device { name: \"b\" external { path: \"../c/s\" } }")
          .what(),
      "/c/hapticd.txtpb:2:31: device[1].external.path: \"/c/s\" is also the socket of another device");
}

TEST(Config, TellsWhatIsWrongWithAnInjectedFault) {
  const auto field_of = [](const std::string& fault) {
    return error_in("device { name: \"a\" simulated { mass: 1 fault { kind: DROP } fault { " + fault +
                    " } } }")
        .field();
  };
  const std::string fault = "device[0].simulated.fault[1]";
  EXPECT_EQ(field_of("at: 1"), fault + ".kind");
  EXPECT_EQ(field_of("kind: DROP at: -1"), fault + ".at");
  EXPECT_EQ(field_of("kind: DROP duration: -1"), fault + ".duration");
  EXPECT_EQ(field_of("kind: DELAY"), fault + ".delay");
  EXPECT_EQ(field_of("kind: DELAY delay: 1.5"), fault + ".delay");
  EXPECT_EQ(field_of("kind: FREEZE delay: 0.1"), fault + ".delay");
  EXPECT_EQ(field_of("kind: JUMP"), fault + ".offset");
  EXPECT_EQ(field_of("kind: JUMP offset { z: 1e7 }"), fault + ".offset.z");
  EXPECT_EQ(field_of("kind: UNPLUG offset { z: 1 }"), fault + ".offset");
}

TEST(Config, ListensToThisMachineOnly) {
  for (const char* address : {"127.0.0.1", "127.1.2.3", "::1"}) {
    config_of(std::string("listen { tcp { address: \"") + address + "\" port: 65535 } }");
  }
  for (const char* address :
       {"0.0.0.0", "::", "10.0.0.1", "::ffff:127.0.0.1", "128.0.0.1", "127.0.0.1 ", "localhost", ""}) {
    EXPECT_EQ(error_in(std::string("listen { tcp { address: \"") + address + "\" port: 1 } }").field(),
              "listen[0].tcp.address");
  }
}

TEST(Config, ListensToOtherMachinesWithTlsOnly) {
  const std::string tls = "tls { certificate: \"d.crt\" key: \"/k\" authority: \"ca.crt\" }";
  const auto tcp = [](const std::string& rest) {
    return "listen { tcp { address: \"0.0.0.0\" port: 7 " + rest + " } }";
  };
  const std::string alice = " allow { name: \"alice\" role: DRIVE }";
  const auto listen = config_of(tcp(tls + alice)).message.listen(0).tcp();
  EXPECT_EQ(listen.tls().certificate(), "/c/d.crt");
  EXPECT_EQ(listen.tls().key(), "/k");
  EXPECT_EQ(listen.tls().authority(), "/c/ca.crt");

  EXPECT_EQ(error_in(tcp("")).field(), "listen[0].tcp.address");
  EXPECT_EQ(error_in(tcp(alice)).field(), "listen[0].tcp.allow");
  EXPECT_EQ(error_in(tcp(tls)).field(), "listen[0].tcp");
  EXPECT_EQ(error_in(tcp(tls + " allow { role: DRIVE }")).field(), "listen[0].tcp.allow[0].name");
  EXPECT_EQ(error_in(tcp(tls + " allow { name: \"alice\" }")).field(), "listen[0].tcp.allow[0].role");
  EXPECT_EQ(error_in(tcp("tls { certificate: \"c\" authority: \"a\" }" + alice)).field(),
            "listen[0].tcp.tls.key");
}

TEST(Config, HasLimitsForClientsAndADriver) {
  const v1::DaemonConfig plain = config_of("").message;
  EXPECT_EQ(plain.limits().clients(), 64U);
  EXPECT_EQ(plain.limits().request_bytes(), 1048576U);
  EXPECT_EQ(plain.limits().items(), 16384U);
  EXPECT_EQ(plain.drive().on_loss(), v1::Drive::FAULT);
  EXPECT_EQ(plain.drive().heartbeat(), 0.1);
  EXPECT_EQ(config_of("capacity { hips: 20000 }").message.limits().items(), 20000U);
  EXPECT_EQ(config_of("drive { on_loss: KEEP heartbeat: 2 }").message.drive().on_loss(), v1::Drive::KEEP);
  EXPECT_EQ(error_in("drive { heartbeat: 0.001 }").field(), "drive.heartbeat");
  EXPECT_EQ(error_in("limits { hello: 0.01 }").field(), "limits.hello");
  EXPECT_EQ(error_in("limits { request_bytes: 100 }").field(), "limits.request_bytes");
}

TEST(Config, HoldsASocketPathThatTheSystemCanHold) {
  // sockaddr_un has 108 bytes, one of them for the end
  config_of("listen { unix { path: \"/" + std::string(106, 'x') + "\" } }");
  EXPECT_EQ(error_in("listen { unix { path: \"/" + std::string(107, 'x') + "\" } }").field(),
            "listen[0].unix.path");
}

TEST(Config, TakesTheFoldersOfRecordingsAndLogsRelativeToItselfAndChecksTheRest) {
  const v1::DaemonConfig config =
      config_of("flight_recorder { directory: \"faults\" seconds: 5 } log { file: \"l\" level: WARNING }")
          .message;
  EXPECT_EQ(config.flight_recorder().directory(), "/c/faults");
  EXPECT_EQ(config.flight_recorder().seconds(), 5.0);
  EXPECT_EQ(config.log().file(), "/c/l");
  EXPECT_EQ(error_in("flight_recorder { seconds: 61 }").field(), "flight_recorder.seconds");
  EXPECT_EQ(error_in("flight_recorder { keep: 20000 }").field(), "flight_recorder.keep");
  EXPECT_EQ(error_in("log { file_bytes: 100 }").field(), "log.file_bytes");
  EXPECT_EQ(error_in("log { level: 9 }").field(), "log.level");
  EXPECT_EQ(error_in("metrics { port: 65536 }").field(), "metrics.port");
}

}  // namespace
}  // namespace haptic::load
