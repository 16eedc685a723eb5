#include "service/service_manager.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/support/notify_socket.h"

namespace haptic::service {
namespace {

using Words = std::vector<std::string>;

TEST(ServiceManager, IsToldEachStateInItsOwnWords) {
  const test::NotifySocket manager;
  tell_status("looking for devices");
  tell_ready("2 devices");
  tell_reloading();
  feed_watchdog();
  tell_stopping();
  EXPECT_EQ(manager.take(), (Words{"STATUS=looking for devices", "READY=1\nSTATUS=2 devices",
                                   "RELOADING=1\nSTATUS=reading the config again", "WATCHDOG=1",
                                   "STOPPING=1\nSTATUS=forces go down"}));
}

TEST(ServiceManager, TakesNoAssignmentFromAStatusWithALineBreak) {
  const test::NotifySocket manager;
  tell_status("evil\nMAINPID=1");
  EXPECT_EQ(manager.take(), Words{"STATUS=evil MAINPID=1"});
}

TEST(ServiceManager, MayBeAbsent) {
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
  tell_ready("nobody listens");
  feed_watchdog();
  EXPECT_FALSE(watchdog_limit_ns());
  EXPECT_TRUE(take_passed_sockets().empty());
}

TEST(ServiceManager, WatchesOnlyTheProcessThatItNames) {
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  EXPECT_EQ(watchdog_limit_ns(), 2'000'000'000);
  ::setenv("WATCHDOG_PID", "1", 1);
  EXPECT_FALSE(watchdog_limit_ns());
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("WATCHDOG_PID");
}

// what the process finds that the manager starts: 0 if all is right, else where it is not
int look_at_passed_sockets() {
  ::setenv("LISTEN_PID", std::to_string(::getpid()).c_str(), 1);
  ::setenv("LISTEN_FDS", "2", 1);
  for (const int place : {3, 4}) {
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    if (socket < 0 || (socket != place && ::dup2(socket, place) != place)) return 1;
  }
  if (take_passed_sockets() != std::vector<int>{3, 4}) return 2;
  if ((::fcntl(3, F_GETFD) & FD_CLOEXEC) == 0) return 3;
  if (::getenv("LISTEN_FDS") != nullptr) return 4;
  return take_passed_sockets().empty() ? 0 : 5;
}

TEST(ServiceManager, PassesItsSocketsOnce) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(look_at_passed_sockets());
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace haptic::service
