#include "rt/realtime_thread.h"

#include <grp.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

namespace haptic::rt {
namespace {

bool warns_of(const RealtimeReport& report, const std::string& text) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

TEST(RealtimeThread, RunsItsBodyOnAnotherThread) {
  std::atomic<pid_t> ran_on{0};
  RealtimeThread thread({}, [&] { ran_on = gettid(); });
  thread.join();
  EXPECT_NE(ran_on, 0);
  EXPECT_NE(ran_on, gettid());
}

TEST(RealtimeThread, ReportsThePolicyThatTheThreadReallyHas) {
  int policy = -1;
  sched_param param{};
  RealtimeThread thread({.priority = 20}, [&] { pthread_getschedparam(pthread_self(), &policy, &param); });
  thread.join();
  const RealtimeReport& report = thread.report();
  EXPECT_EQ(report.fifo, policy == SCHED_FIFO);
  EXPECT_EQ(report.priority, report.fifo ? param.sched_priority : 0);
  EXPECT_EQ(report.fifo && report.priority == 20, report.warnings.empty());
}

TEST(RealtimeThread, BindsToTheCpuThatIsAsked) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  unsigned cpu = 0;
  while (!CPU_ISSET(cpu, &allowed)) ++cpu;
  int ran_on = -1;
  RealtimeThread thread({.cpu = cpu}, [&] { ran_on = sched_getcpu(); });
  thread.join();
  EXPECT_EQ(thread.report().cpu, cpu);
  EXPECT_EQ(ran_on, static_cast<int>(cpu));
}

TEST(RealtimeThread, ACpuThatDoesNotExistIsAWarningAndTheThreadRuns) {
  for (const unsigned cpu : {1000u, 4'000'000'000u}) {
    std::atomic<bool> ran{false};
    RealtimeThread thread({.cpu = cpu}, [&] { ran = true; });
    thread.join();
    EXPECT_TRUE(ran);
    EXPECT_FALSE(thread.report().cpu.has_value());
    EXPECT_TRUE(warns_of(thread.report(), "binding to CPU " + std::to_string(cpu)));
  }
}

TEST(RealtimeThread, APriorityThatDoesNotExistIsAWarningAndTheThreadRuns) {
  std::atomic<bool> ran{false};
  RealtimeThread thread({.priority = 1000}, [&] { ran = true; });
  thread.join();
  EXPECT_TRUE(ran);
  EXPECT_TRUE(warns_of(thread.report(), "real-time priority 1000"));
}

// In a child process without rights: an ordinary user with small limits, as on any desktop.
void expect_it_runs_without_rights(rlim_t memlock) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit no_priority{0, 0};
    const rlimit memory{memlock, memlock};
    setrlimit(RLIMIT_RTPRIO, &no_priority);
    setrlimit(RLIMIT_MEMLOCK, &memory);
    if (geteuid() == 0 && (setgroups(0, nullptr) != 0 || setgid(65534) != 0 || setuid(65534) != 0)) _exit(77);
    std::atomic<bool> ran{false};
    RealtimeThread thread({.priority = 80, .lock_memory = true}, [&] { ran = true; });
    thread.join();
    if (!ran) _exit(1);
    if (thread.report().fifo || !warns_of(thread.report(), "real-time priority 80")) _exit(2);
    if (!warns_of(thread.report(), "memory") || !warns_of(thread.report(), "LimitMEMLOCK")) _exit(3);
    // memory that is asked for later is not refused
    constexpr std::size_t kMuch = 64u << 20;
    void* const later = mmap(nullptr, kMuch, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    _exit(later == MAP_FAILED ? 4 : 0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "cannot give up rights here";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(RealtimeThread, RunsAndSaysWhyWhenTheUserHasNoRights) { expect_it_runs_without_rights(8u << 20); }

TEST(RealtimeThread, RunsAndSaysWhyWhenNoMemoryMayBeLocked) { expect_it_runs_without_rights(0); }

TEST(RealtimeThread, DoesNotLockFutureMemoryUnderALimitThatThePresentMemoryFits) {
  expect_it_runs_without_rights(rlim_t{256} << 20);
}

}  // namespace
}  // namespace haptic::rt
