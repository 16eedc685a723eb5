// The clients of the releases against the daemon of today.

#include <gtest/gtest.h>
#include <stdio.h>
#include <sys/wait.h>

#include <thread>

#include "tests/compatibility/releases.h"
#include "tests/support/places.h"
#include "tests/support/test_daemon.h"

namespace haptic::test {
namespace {

class FrozenClient : public testing::TestWithParam<std::string> {};

TEST_P(FrozenClient, GreetsAsksSubscribesArmsAndDisarms) {
  TestDaemon daemon(with_role(v1::ADMIN));
  const std::jthread ticker([&daemon](const std::stop_token& stop) {
    for (std::uint64_t tick = 1; !stop.stop_requested(); ++tick) {
      daemon.servo().publish(tick, [](servo::Snapshot& snapshot) {
        snapshot.objects.resize(1);
        snapshot.hips.resize(2);
        snapshot.devices.resize(1);
      });
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  const std::string command = test::build_dir() + "/tests/compatibility/" + GetParam() + "/frozen_client_" +
                              GetParam() + " " + daemon.address() + " 2>&1";
  FILE* const pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string output;
  char chunk[1024];
  while (const std::size_t size = ::fread(chunk, 1, sizeof(chunk), pipe)) {
    output.append(chunk, size);
  }
  EXPECT_EQ(::pclose(pipe), 0) << output;
  using servo::CommandKind;
  EXPECT_EQ(daemon.servo().seen(), (std::vector<CommandKind>{CommandKind::kArm, CommandKind::kDisarm}));
}

INSTANTIATE_TEST_SUITE_P(Releases, FrozenClient, testing::ValuesIn(frozen_releases()),
                         [](const auto& release) { return release.param; });

}  // namespace
}  // namespace haptic::test
