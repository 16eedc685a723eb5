#include "client/doctor/nodes.h"

#include <fmt/format.h>

namespace haptic::doctor {

namespace {

std::string last_part(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

bool check_holders(const Machine& machine, const std::string& about, const std::string& node,
                   Findings& findings) {
  bool is_free = true;
  for (const Holder& holder : machine.holders(node)) {
    if (holder.program == "hapticd") continue;
    findings.push_back({about, Verdict::kBad,
                        fmt::format("{} is held by {} (process {})", node, holder.program, holder.pid),
                        fmt::format("kill {}", holder.pid)});
    is_free = false;
  }
  return is_free;
}

void check_latency_timer(const Machine& machine, const std::string& about, const std::string& tty,
                         Findings& findings) {
  const std::string file = "/sys/bus/usb-serial/devices/" + tty + "/latency_timer";
  const std::optional<double> timer = machine.number(file);
  if (!timer || *timer <= 1.0) return;
  findings.push_back(
      {about, Verdict::kWarning,
       fmt::format("its USB adapter keeps what the device sends for up to {:.0f} ms (latency_timer)", *timer),
       "echo 1 | sudo tee " + file});
}

}  // namespace

bool check_node(const Machine& machine, const std::string& about, const std::string& node,
                Findings& findings) {
  if (!machine.exists(node)) {
    findings.push_back({about, Verdict::kBad, node + " is not there", "sudo udevadm trigger"});
    return false;
  }
  const std::string& user = machine.user().name;
  if (!machine.may(Access::kReadAndWrite, node)) {
    const std::string group = machine.group_with_rights(node);
    findings.push_back(
        {about, Verdict::kBad,
         fmt::format("{} ({}) may not be opened by {}{}", node, machine.rights(node), user,
                     group.empty() ? "" : "; a new login has the new group"),
         group.empty() ? std::string(kInstallRules) : fmt::format("sudo usermod -aG {} {}", group, user)});
    return false;
  }
  return check_holders(machine, about, node, findings);
}

bool check_serial(const Machine& machine, const std::string& about, const std::string& port,
                  Findings& findings) {
  if (!machine.exists(port)) {
    findings.push_back({about, Verdict::kBad, port + " is not there", "ls -l /dev/serial/by-id"});
    return false;
  }
  const std::string node = machine.resolved(port);
  const bool is_good = check_node(machine, about, node, findings);
  check_latency_timer(machine, about, last_part(node), findings);
  if (!machine.processes("ModemManager").empty()) {
    findings.push_back(
        {about, Verdict::kWarning,
         "ModemManager talks to serial ports when they are plugged in, unless the rules say otherwise",
         kInstallRules});
  }
  return is_good;
}

}  // namespace haptic::doctor
