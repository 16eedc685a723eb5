#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "client/doctor/checks.h"
#include "client/doctor/nodes.h"

namespace haptic::doctor {

namespace {

constexpr std::uint32_t kDefaultPriority = 80;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The daemon's folder in /proc, or this program's own.
std::string subject(const Machine& machine) {
  const std::vector<int> daemons = machine.processes("hapticd");
  return daemons.empty() ? "/proc/self" : "/proc/" + std::to_string(daemons.front());
}

void kernel(const Machine& machine, Findings& findings) {
  const std::string release = machine.line("/proc/sys/kernel/osrelease").value_or("of an unknown release");
  const std::string version = machine.line("/proc/version").value_or("");
  if (machine.line("/sys/kernel/realtime") == "1" || contains(version, "PREEMPT_RT")) {
    findings.push_back({"kernel", Verdict::kOk, release + " is fully preemptible (PREEMPT_RT)"});
  } else if (contains(machine.line("/proc/cmdline").value_or(""), "preempt=full")) {
    findings.push_back({"kernel", Verdict::kNote,
                        release + " is preemptible (preempt=full), and not a real-time kernel",
                        "sudo apt install linux-image-rt-amd64"});
  } else {
    findings.push_back(
        {"kernel", Verdict::kNote,
         release + " is not a real-time kernel: now and then a tick will be late by more than a tenth of a "
                   "millisecond",
         "sudo apt install linux-image-rt-amd64"});
  }
}

/// The soft limit of that name in /proc/PID/limits; "unlimited" is more than any number.
std::optional<double> limit_of(const Machine& machine, const std::string& name) {
  std::istringstream lines(machine.text(subject(machine) + "/limits").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name)) continue;
    std::istringstream values(line.substr(name.size()));
    std::string soft;
    values >> soft;
    if (soft == "unlimited") return 1e300;
    std::istringstream number(soft);
    double value = 0.0;
    if (number >> value) return value;
  }
  return std::nullopt;
}

void limits(const Machine& machine, const v1::Servo& servo, Findings& findings) {
  if (machine.user().uid == 0) {
    findings.push_back({"limits", Verdict::kOk, "root has all real-time rights"});
    return;
  }
  const std::string who =
      machine.processes("hapticd").empty() ? "a program started here" : "the running daemon";
  const std::uint32_t priority = servo.priority() == 0 ? kDefaultPriority : servo.priority();
  const std::optional<double> granted = limit_of(machine, "Max realtime priority");
  if (!granted) {
    findings.push_back({"priority", Verdict::kNote, "the limit of real-time priority cannot be read"});
  } else if (*granted >= priority) {
    findings.push_back({"priority", Verdict::kOk, fmt::format("{} may have SCHED_FIFO {}", who, priority)});
  } else {
    findings.push_back(
        {"priority", Verdict::kWarning,
         fmt::format(
             "{} may have SCHED_FIFO up to {:.0f}, and servo.priority is {}; a new login has the new limit",
             who, *granted, priority),
         fmt::format("echo '{} - rtprio 95' | sudo tee /etc/security/limits.d/hapticd.conf",
                     machine.user().name)});
  }
  const std::optional<double> locked = limit_of(machine, "Max locked memory");
  constexpr double kEnough = 1e300;
  if (!locked) {
    findings.push_back({"memory", Verdict::kNote, "the limit of locked memory cannot be read"});
  } else if (*locked >= kEnough) {
    findings.push_back({"memory", Verdict::kOk, who + " may lock all of its memory"});
  } else {
    findings.push_back(
        {"memory", servo.lock_memory() ? Verdict::kWarning : Verdict::kNote,
         fmt::format(
             "{} may lock {:.0f} KiB only: a page fault can delay a tick; a new login has the new limit", who,
             *locked / 1024.0),
         fmt::format("echo '{} - memlock unlimited' | sudo tee -a /etc/security/limits.d/hapticd.conf",
                     machine.user().name)});
  }
}

void throttling(const Machine& machine, Findings& findings) {
  const std::optional<double> runtime = machine.number("/proc/sys/kernel/sched_rt_runtime_us");
  const double period = machine.number("/proc/sys/kernel/sched_rt_period_us").value_or(1e6);
  const std::string command = "sudo sysctl kernel.sched_rt_runtime_us=950000";
  if (!runtime || period <= 0.0) {
    findings.push_back({"throttling", Verdict::kNote, "the share of real-time threads cannot be read"});
  } else if (*runtime < 0.0) {
    findings.push_back({"throttling", Verdict::kNote,
                        "off: a real-time thread that never sleeps would stop its core for good", command});
  } else if (*runtime == 0.0) {
    findings.push_back({"throttling", Verdict::kBad, "real-time threads may not run at all", command});
  } else if (*runtime / period < 0.5) {
    findings.push_back(
        {"throttling", Verdict::kWarning,
         fmt::format("real-time threads may use {:.0f} % of a core only", 100.0 * *runtime / period),
         command});
  } else {
    findings.push_back(
        {"throttling", Verdict::kOk,
         fmt::format("real-time threads may use {:.0f} % of a core", 100.0 * *runtime / period)});
  }
}

void cgroup(const Machine& machine, Findings& findings) {
  std::istringstream lines(machine.text(subject(machine) + "/cgroup").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string path = line.substr(second + 1);
    if (controllers.empty()) {  // version 2
      const std::string file = "/sys/fs/cgroup" + path + (path.ends_with('/') ? "" : "/") + "cpu.max";
      const std::string most = machine.line(file).value_or("max");
      if (most.starts_with("max")) continue;
      findings.push_back({"cgroup", Verdict::kWarning,
                          "its processor time is limited to " + most + " (us in a period of us)",
                          "echo max | sudo tee " + file});
      return;
    }
    if (!contains("," + controllers + ",", ",cpu,")) continue;
    const std::string file = fmt::format("/sys/fs/cgroup/{}{}{}cpu.rt_runtime_us", controllers, path,
                                         path.ends_with('/') ? "" : "/");
    const std::optional<double> runtime = machine.number(file);
    if (!runtime || *runtime != 0.0) continue;
    findings.push_back({"cgroup", Verdict::kBad, "its group has no time for real-time threads",
                        "echo 950000 | sudo tee " + file});
    return;
  }
  findings.push_back({"cgroup", Verdict::kOk, "its group sets no limit to processor time"});
}

void clock(const Machine& machine, Findings& findings) {
  const std::string folder = "/sys/devices/system/clocksource/clocksource0/";
  const std::string source = machine.line(folder + "current_clocksource").value_or("");
  const std::string available = " " + machine.line(folder + "available_clocksource").value_or("") + " ";
  if (source.empty()) {
    findings.push_back({"clock", Verdict::kNote, "the clock source cannot be read"});
  } else if (source == "hpet" || source == "acpi_pm" || source == "jiffies" || source == "refined-jiffies") {
    const bool has_tsc = contains(available, " tsc ");
    findings.push_back({"clock", Verdict::kWarning,
                        source + " takes microseconds to read, and the tick reads it many times",
                        has_tsc ? "echo tsc | sudo tee " + folder + "current_clocksource" : ""});
  } else {
    findings.push_back({"clock", Verdict::kOk, source + " is read in nanoseconds"});
  }
}

std::vector<std::string> cores(const Machine& machine) {
  std::vector<std::string> names;
  for (const std::string& name : machine.list("/sys/devices/system/cpu")) {
    if (name.size() > 3 && name.starts_with("cpu") &&
        name.find_first_not_of("0123456789", 3) == std::string::npos) {
      names.push_back(name);
    }
  }
  return names;
}

/// Those that matter: the servo's own, or all of them.
std::vector<std::string> cores_of(const Machine& machine, const v1::Servo& servo) {
  if (servo.has_cpu()) return {"cpu" + std::to_string(servo.cpu())};
  return cores(machine);
}

void governor(const Machine& machine, const v1::Servo& servo, Findings& findings) {
  std::string slow;
  bool is_any = false;
  for (const std::string& core : cores_of(machine, servo)) {
    const auto told = machine.line("/sys/devices/system/cpu/" + core + "/cpufreq/scaling_governor");
    is_any = is_any || told;
    if (told && *told != "performance") slow += (slow.empty() ? "" : ", ") + core + " " + *told;
  }
  if (!is_any) {
    findings.push_back({"governor", Verdict::kOk, "the kernel does not change the cores' frequency"});
  } else if (slow.empty()) {
    findings.push_back({"governor", Verdict::kOk, "performance"});
  } else {
    findings.push_back({"governor", Verdict::kWarning,
                        "cores are slowed down when they have little to do, and a tick is little: " + slow,
                        "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"});
  }
}

void sleep_states(const Machine& machine, const v1::Servo& servo, Findings& findings) {
  constexpr double kLong = 20.0;  // us
  double longest = 0.0;
  std::string which;
  for (const std::string& core : cores_of(machine, servo)) {
    const std::string folder = "/sys/devices/system/cpu/" + core + "/cpuidle";
    for (const std::string& state : machine.list(folder)) {
      const std::string at = fmt::format("{}/{}", folder, state);
      const double latency = machine.number(at + "/latency").value_or(0.0);
      if (machine.line(at + "/disable") == "1" || latency <= longest) continue;
      longest = latency;
      which = machine.line(at + "/name").value_or(state);
    }
  }
  if (longest <= kLong) {
    findings.push_back({"sleep", Verdict::kOk, "no core sleeps so deeply that it takes long to wake"});
  } else if (machine.may(Access::kWrite, "/dev/cpu_dma_latency")) {
    findings.push_back(
        {"sleep", Verdict::kOk,
         fmt::format("cores wake from {} in {:.0f} us; the daemon holds them awake while it is armed", which,
                     longest)});
  } else {
    findings.push_back(
        {"sleep", Verdict::kWarning,
         fmt::format("cores need up to {:.0f} us to wake from {}, and {} may not hold them awake through "
                     "/dev/cpu_dma_latency",
                     longest, which, machine.user().name),
         kInstallRules});
  }
}

bool has(const std::vector<unsigned>& numbers, unsigned number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

void core(const Machine& machine, const v1::Servo& servo, Findings& findings) {
  const std::string folder = "/sys/devices/system/cpu/";
  const std::string isolated = machine.line(folder + "isolated").value_or("");
  if (!servo.has_cpu()) {
    findings.push_back({"core", Verdict::kNote,
                        isolated.empty()
                            ? "the servo thread is bound to no core (servo.cpu), and none is kept free for it"
                            : "core " + isolated + " is kept free, and servo.cpu does not name it"});
    return;
  }
  const unsigned cpu = servo.cpu();
  const auto online = machine.line(folder + "online");
  if (online && !has(numbers_of(*online), cpu)) {
    findings.push_back(
        {"core", Verdict::kBad, fmt::format("servo.cpu is {}, and there are {}", cpu, *online)});
    return;
  }
  if (has(numbers_of(isolated), cpu)) {
    findings.push_back({"core", Verdict::kOk, fmt::format("core {} is kept free for the servo thread", cpu)});
  } else {
    findings.push_back(
        {"core", Verdict::kNote,
         fmt::format("other programs run on core {}, too; in /etc/default/grub, then update-grub: "
                     "isolcpus={} nohz_full={} rcu_nocbs={}",
                     cpu, cpu, cpu, cpu)});
  }
}

void interrupts(const Machine& machine, const v1::Servo& servo, Findings& findings) {
  if (!servo.has_cpu()) return;
  std::string there;
  int count = 0;
  for (const std::string& irq : machine.list("/proc/irq")) {
    const auto cores_of_irq = machine.line("/proc/irq/" + irq + "/effective_affinity_list");
    if (!cores_of_irq || !has(numbers_of(*cores_of_irq), servo.cpu())) continue;
    constexpr int kTold = 8;
    if (++count <= kTold) there += (there.empty() ? "" : ", ") + irq;
  }
  if (count == 0) {
    findings.push_back({"interrupts", Verdict::kOk, fmt::format("none is served on core {}", servo.cpu())});
    return;
  }
  findings.push_back(
      {"interrupts", Verdict::kNote,
       fmt::format("{} served on core {}: {}{}", count, servo.cpu(), there, count > 8 ? ", ..." : ""),
       fmt::format("grep . /proc/irq/*/effective_affinity_list; echo 0 | sudo tee "
                   "/proc/irq/NUMBER/smp_affinity_list")});
  if (!machine.processes("irqbalance").empty()) {
    findings.push_back(
        {"interrupts", Verdict::kNote, "irqbalance moves them as it likes",
         fmt::format("echo IRQBALANCE_BANNED_CPULIST={} | sudo tee -a /etc/default/irqbalance && sudo "
                     "systemctl restart irqbalance",
                     servo.cpu())});
  }
}

}  // namespace

void check_real_time(const Machine& machine, const v1::Servo& servo, Findings& findings) {
  kernel(machine, findings);
  limits(machine, servo, findings);
  throttling(machine, findings);
  cgroup(machine, findings);
  clock(machine, findings);
  governor(machine, servo, findings);
  sleep_states(machine, servo, findings);
  core(machine, servo, findings);
  interrupts(machine, servo, findings);
}

}  // namespace haptic::doctor
