#include "load/config_difference.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

namespace haptic::load {
namespace {

using Fields = std::vector<std::string>;

v1::DaemonConfig config(const std::string& text) {
  v1::DaemonConfig message;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &message)) << text;
  return message;
}

ConfigDifference between(const std::string& running, const std::string& wanted) {
  return compare(config(running), config(wanted));
}

TEST(ConfigDifference, IsNothingBetweenEqualConfigs) {
  const ConfigDifference same = between("servo { rate_hz: 1000 }", "servo { rate_hz: 1000 }");
  EXPECT_EQ(same.taken_over, Fields{});
  EXPECT_EQ(same.needs_restart, Fields{});
}

TEST(ConfigDifference, TakesOverLimitsAndTheRulesOfTheDriveLease) {
  const ConfigDifference changed = between("limits { clients: 4 } drive { heartbeat: 0.1 }",
                                           "limits { clients: 5 } drive { heartbeat: 0.2 on_loss: DISARM }");
  EXPECT_EQ(changed.taken_over, (Fields{"limits.clients", "drive.on_loss", "drive.heartbeat"}));
  EXPECT_EQ(changed.needs_restart, Fields{});
}

TEST(ConfigDifference, TakesOverWhoMayComeInAndWithWhichCertificates) {
  const char* const unix_before = "listen { unix { path: 's' allow { group: 'a' role: DRIVE } } }";
  const char* const unix_after =
      "listen { unix { path: 's' allow { group: 'a' role: OBSERVE } allow { group: 'b' role: DRIVE } } }";
  EXPECT_EQ(between(unix_before, unix_after).taken_over,
            (Fields{"listen[0].unix.allow[0].role", "listen[0].unix.allow[1]"}));
  EXPECT_EQ(between(unix_after, unix_before).taken_over,
            (Fields{"listen[0].unix.allow[0].role", "listen[0].unix.allow[1]"}));
  EXPECT_EQ(between("listen { tcp { address: 'x' tls { key: 'k' } allow { name: 'a' role: DRIVE } } }",
                    "listen { tcp { address: 'x' tls { key: 'l' } allow { name: 'b' role: DRIVE } } }")
                .taken_over,
            (Fields{"listen[0].tcp.tls.key", "listen[0].tcp.allow[0].name"}));
}

TEST(ConfigDifference, NeedsARestartForEverythingElse) {
  const char* const pairs[][3] = {
      {"servo { rate_hz: 1000 }", "servo { rate_hz: 500 }", "servo.rate_hz"},
      {"safety { max_force: 1 }", "safety { max_force: 2 }", "safety.max_force"},
      {"scene: 'a'", "scene: 'b'", "scene"},
      {"device { name: 'a' }", "device { name: 'a' } device { name: 'b' }", "device[1]"},
      {"device { name: 'a' virtual {} }", "device { name: 'b' virtual {} }", "device[0].name"},
      {"listen { unix { path: 's' } }", "listen { unix { path: 't' } }", "listen[0].unix.path"},
      {"listen { tcp { address: 'x' } }", "listen { tcp { address: 'x' tls { key: 'k' } } }",
       "listen[0].tcp.tls"},
      {"", "listen { tcp { address: 'x' } }", "listen[0]"},
  };
  for (const auto& [running, wanted, field] : pairs) {
    const ConfigDifference changed = between(running, wanted);
    EXPECT_EQ(changed.needs_restart, Fields{field});
    EXPECT_EQ(changed.taken_over, Fields{}) << field;
  }
}

TEST(AfterReload, RunsWithWhatWasTakenOverAndNothingElse) {
  const v1::DaemonConfig after = after_reload(
      config("servo { rate_hz: 1000 } limits { clients: 4 } listen { unix { path: 's' } }"),
      config(
          "servo { rate_hz: 500 } limits { clients: 5 } listen { unix { path: 's' allow { group: 'a' } } }"));
  EXPECT_EQ(after.servo().rate_hz(), 1000.0);
  EXPECT_EQ(after.limits().clients(), 5U);
  EXPECT_EQ(after.listen(0).unix().allow_size(), 1);
}

TEST(AfterReload, KeepsTheListenersThatAreOpen) {
  const v1::DaemonConfig after =
      after_reload(config("listen { unix { path: 's' } }"), config("listen { unix { path: 't' } }"));
  EXPECT_EQ(after.listen(0).unix().path(), "s");
}

}  // namespace
}  // namespace haptic::load
