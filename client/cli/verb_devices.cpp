#include <fmt/format.h>

#include <cmath>

#include "client/cli/describe.h"
#include "client/cli/table.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

std::string joined(const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text.empty() ? "-" : text;
}

double length(const v1::Vector3& v) { return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z()); }

ExitCode show_devices(Command& command) {
  client::Connection& daemon = command.connect();
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_list_devices(); });
  if (command.json) {
    for (const v1::DeviceStatus& device : response.devices().device()) {
      print_json(device);
    }
    return kDone;
  }
  Table table({{"device", Align::kLeft},
               {"driver", Align::kLeft},
               {"x mm"},
               {"y mm"},
               {"z mm"},
               {"force N"},
               {"limit N"},
               {"age ms"},
               {"fingers", Align::kLeft},
               {"state", Align::kLeft}});
  for (const v1::DeviceStatus& device : response.devices().device()) {
    const v1::Vector3& at = device.pose().position();
    const bool faulty = device.fault().kind() != v1::FAULT_NONE;
    table.add({device.description().name(), device.description().driver(), millimetres(at.x()),
               millimetres(at.y()), millimetres(at.z()),
               fmt::format("{:.3f}", length(device.wrench().force())),
               fmt::format("{:.3g}", device.description().max_force()),
               fmt::format("{:.1f}", device.sample_age() * 1e3), joined(device.description().finger()),
               faulty             ? "FAULT " + describe(device.fault().kind())
               : device.present() ? "present"
                                  : "absent"});
  }
  fmt::print("{}", table.empty() ? "the daemon has no devices; its config names them\n" : table.to_string());
  return kDone;
}

}  // namespace

void add_devices(CLI::App& app, Command& command) {
  add_verb(app, command, "devices", "the devices, where they are and what they push", show_devices);
}

}  // namespace haptic::cli
