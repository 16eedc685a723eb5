#include "rt/realtime_thread.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <future>
#include <memory>
#include <system_error>
#include <utility>

namespace haptic::rt {

namespace {

// a tick needs a few KiB. A small stack still fits when the memlock limit is the usual 8 MiB, at which a
// default stack of 8 MiB could not be made while future memory is locked. glibc takes the thread-local
// storage of all libraries from it, of which ThreadSanitizer's alone is 0.8 MiB
constexpr std::size_t kStackBytes = std::size_t{1536} * 1024;
constexpr std::size_t kPrefaultedBytes = std::size_t{256} * 1024;

std::string reason(int error) { return std::generic_category().message(error); }

void prefault_stack() noexcept {
  constexpr std::size_t kPage = 4096;
  unsigned char stack[kPrefaultedBytes];
  volatile unsigned char* const bytes = stack;
  for (std::size_t i = 0; i < kPrefaultedBytes; i += kPage) bytes[i] = 0;
}

bool has_ipc_lock_capability() {
  constexpr unsigned kCapIpcLock = 14;  // linux/capability.h
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> status(std::fopen("/proc/self/status", "re"),
                                                               std::fclose);
  if (!status) return false;
  char line[256];
  while (std::fgets(line, sizeof line, status.get()) != nullptr) {
    unsigned long long effective = 0;
    if (std::sscanf(line, "CapEff: %llx", &effective) == 1) return ((effective >> kCapIpcLock) & 1) != 0;
  }
  return false;
}

void request_priority(int priority, RealtimeReport& report) {
  sched_param param{};
  param.sched_priority = priority;
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param); error != 0) {
    report.warnings.push_back("real-time priority " + std::to_string(priority) +
                              " (SCHED_FIFO): " + reason(error) +
                              "; grant it by LimitRTPRIO= in the unit or rtprio in "
                              "/etc/security/limits.d");
  }
  // what holds in the end may also have been inherited from the service manager
  int policy = SCHED_OTHER;
  if (const int error = pthread_getschedparam(pthread_self(), &policy, &param); error != 0) {
    report.warnings.push_back("the scheduling policy cannot be read: " + reason(error));
    return;
  }
  report.fifo = (policy & ~SCHED_RESET_ON_FORK) == SCHED_FIFO;
  report.priority = report.fifo ? param.sched_priority : 0;
}

void request_cpu(unsigned cpu, RealtimeReport& report) {
  int error = EINVAL;
  if (cpu < CPU_SETSIZE) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(cpu, &set);
    error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  }
  if (error == 0) {
    report.cpu = cpu;
    return;
  }
  report.warnings.push_back("binding to CPU " + std::to_string(cpu) + ": " + reason(error) +
                            "; name a CPU in servo.cpu that exists and that the service may use "
                            "(CPUAffinity=, AllowedCPUs= in the unit)");
}

void request_memory_lock(RealtimeReport& report) {
  rlimit limit{};
  const bool known = getrlimit(RLIMIT_MEMLOCK, &limit) == 0;
  const bool unlimited = (known && limit.rlim_cur == RLIM_INFINITY) || has_ipc_lock_capability();
  const std::string remedy =
      "; grant it by LimitMEMLOCK=infinity in the unit or memlock in "
      "/etc/security/limits.d";

  // under a limit future memory must stay unlocked: beyond it every allocation and thread would fail
  if (mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) != 0) {
    report.warnings.push_back("locking memory: " + reason(errno) + remedy);
    return;
  }
  report.memory_locked = true;
  if (!unlimited) {
    report.warnings.push_back(
        "memory is locked as it is now, but memory that is allocated later is not, "
        "because of the memlock limit" +
        remedy);
  }
}

}  // namespace

struct RealtimeThread::Start {
  RealtimeSettings settings;
  std::function<void()> body;
  RealtimeReport report;
  std::promise<void> rights_settled;
  std::promise<void> go;
};

void* RealtimeThread::run(void* argument) {
  Start& start = *static_cast<Start*>(argument);
  request_priority(start.settings.priority, start.report);
  if (start.settings.cpu) request_cpu(*start.settings.cpu, start.report);
  prefault_stack();
  start.rights_settled.set_value();
  start.go.get_future().wait();
  start.body();
  return nullptr;
}

RealtimeThread::RealtimeThread(const RealtimeSettings& settings, std::function<void()> body)
    : start_(std::make_unique<Start>()) {
  start_->settings = settings;
  start_->body = std::move(body);

  pthread_attr_t attributes;
  if (const int error = pthread_attr_init(&attributes); error != 0) {
    throw std::system_error(error, std::generic_category(), "creating the servo thread");
  }
  if (const int error = pthread_attr_setstacksize(&attributes, kStackBytes); error != 0) {
    start_->report.warnings.push_back("a small stack for the servo thread: " + reason(error) +
                                      "; it has one of the default size");
  }
  const int error = pthread_create(&thread_, &attributes, &run, start_.get());
  pthread_attr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "creating the servo thread");
  joinable_ = true;

  start_->rights_settled.get_future().wait();
  // after the thread exists, so that a limit on locked memory cannot keep it from being created
  if (settings.lock_memory) request_memory_lock(start_->report);
  start_->go.set_value();
}

const RealtimeReport& RealtimeThread::report() const noexcept { return start_->report; }

RealtimeThread::~RealtimeThread() { join(); }

void RealtimeThread::join() noexcept {
  if (!joinable_) return;
  pthread_join(thread_, nullptr);
  joinable_ = false;
}

}  // namespace haptic::rt
