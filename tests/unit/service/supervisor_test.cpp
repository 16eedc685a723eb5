#include "service/supervisor.h"

#include <gtest/gtest.h>

#include "tests/support/notify_socket.h"

namespace haptic::service {
namespace {

using Words = std::vector<std::string>;

constexpr std::int64_t kMs = 1'000'000;

void watch_for(const char* microseconds) {
  ::setenv("WATCHDOG_USEC", microseconds, 1);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
}

TEST(Supervisor, TellsReadyWhenTicksKeepTheirPeriodAndThenThatItLives) {
  const test::NotifySocket manager;
  watch_for("2000000");
  Supervisor supervisor(1000.0, "2 devices");
  EXPECT_EQ(manager.take(), Words{"STATUS=waiting until the servo thread keeps its period"});
  supervisor.look(0, 0);
  EXPECT_EQ(manager.take(), Words{});
  supervisor.look(200 * kMs, 200);
  EXPECT_EQ(manager.take(), Words{"READY=1\nSTATUS=2 devices"});
  supervisor.look(700 * kMs, 700);
  EXPECT_EQ(manager.take(), Words{"WATCHDOG=1"});
  supervisor.look(1200 * kMs, 700);  // it hangs
  supervisor.look(9200 * kMs, 700);
  EXPECT_EQ(manager.take(), Words{});
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("WATCHDOG_PID");
}

TEST(Supervisor, ReloadsBetweenTwoWordsOnceItIsReady) {
  const test::NotifySocket manager;
  Supervisor supervisor(1000.0, "2 devices");
  supervisor.look(0, 0);
  supervisor.look(200 * kMs, 200);
  manager.take();
  Words before;
  supervisor.reload([&] { before = manager.take(); });
  EXPECT_EQ(before, Words{"RELOADING=1\nSTATUS=reading the config again"});
  EXPECT_EQ(manager.take(), Words{"READY=1\nSTATUS=2 devices"});
}

TEST(Supervisor, IsNotMadeReadyByAReload) {
  const test::NotifySocket manager;
  Supervisor supervisor(1000.0, "2 devices");
  manager.take();
  bool called = false;
  supervisor.reload([&] { called = true; });
  EXPECT_TRUE(called);
  EXPECT_EQ(manager.take(), Words{});
}

}  // namespace
}  // namespace haptic::service
