#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>

#include "client/cli/describe.h"
#include "client/cli/screen.h"
#include "client/cli/table.h"
#include "client/cli/verbs.h"
#include "client/lib/error.h"

namespace haptic::cli {
namespace {

constexpr std::chrono::milliseconds kPatience{200};  // then a signal is looked at

std::string joined(const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text.empty() ? "-" : text;
}

double length(const v1::Vector3& v) { return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z()); }

// a daemon before phases told only whether there are samples
std::string state_of(const v1::DeviceStatus& device) {
  std::string fault =
      device.fault().kind() == v1::FAULT_NONE ? "" : "FAULT " + describe(device.fault().kind());
  switch (device.phase()) {
    case v1::DEVICE_PHASE_UNSPECIFIED:
      return !fault.empty() ? fault : device.present() ? "present" : "absent";
    case v1::DEVICE_FAULT:
      return fault;
    default:
      return describe(device.phase()) + (fault.empty() ? "" : ", " + fault);
  }
}

void print_table(const v1::DeviceList& devices) {
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
  std::string reasons;
  for (const v1::DeviceStatus& device : devices.device()) {
    const v1::Vector3& at = device.pose().position();
    table.add({device.description().name(), device.description().driver(), millimetres(at.x()),
               millimetres(at.y()), millimetres(at.z()),
               fmt::format("{:.3f}", length(device.wrench().force())),
               fmt::format("{:.3g}", device.description().max_force()),
               fmt::format("{:.1f}", device.sample_age() * 1e3), joined(device.description().finger()),
               state_of(device)});
    if (!device.reason().empty()) {
      reasons += fmt::format("{}: {}\n", device.description().name(), device.reason());
    }
  }
  fmt::print("{}{}", table.empty() ? "the daemon has no devices; its config names them\n" : table.to_string(),
             reasons);
}

v1::DeviceList ask_devices(client::Connection& daemon) {
  return call(daemon, [](v1::Request& request) { request.mutable_list_devices(); }).devices();
}

ExitCode list_devices(Command& command) {
  const v1::DeviceList devices = ask_devices(command.connect());
  if (!command.json) {
    print_table(devices);
    return kDone;
  }
  for (const v1::DeviceStatus& device : devices.device()) {
    print_json(device);
  }
  return kDone;
}

/// The list, and then a line for each change until it is stopped.
ExitCode watch_devices(Command& command) {
  catch_stop_signals();
  const ExitCode listed = list_devices(command);
  client::Connection& daemon = command.connect();
  std::fflush(stdout);
  while (listed == kDone && !stop_requested()) {
    const auto message = daemon.receive(kPatience);
    if (!message || message->event().kind() != v1::Event::DEVICE_CHANGED) {
      continue;
    }
    if (command.json) {
      print_json(message->event());
    } else {
      fmt::print("tick {}: {}\n", message->event().tick(), message->event().message());
    }
    std::fflush(stdout);
  }
  return listed;
}

void line(const char* what, const std::string& value) { fmt::print("{:<10} {}\n", what, value); }

ExitCode show_device(Command& command, const std::string& name) {
  const v1::DeviceList devices = ask_devices(command.connect());
  for (const v1::DeviceStatus& device : devices.device()) {
    const v1::DeviceDescription& description = device.description();
    if (description.name() != name) {
      continue;
    }
    if (command.json) {
      print_json(device);
      return kDone;
    }
    const v1::Vector3& at = device.pose().position();
    line("device", name);
    line("driver", description.driver());
    line("state", state_of(device));
    if (!device.reason().empty()) {
      line("reason", device.reason());
    }
    line("serial", device.serial().empty() ? "-" : device.serial());
    line("losses", fmt::format("{}", device.losses()));
    line("fingers", joined(description.finger()));
    line("position",
         fmt::format("{} {} {} mm", millimetres(at.x()), millimetres(at.y()), millimetres(at.z())));
    line("buttons", fmt::format("{:#b}", device.buttons()));
    line("force",
         fmt::format("{:.3f} N of {:.3g} N", length(device.wrench().force()), description.max_force()));
    line("sample", device.present() ? fmt::format("{:.1f} ms old", device.sample_age() * 1e3) : "none");
    if (device.fault().kind() != v1::FAULT_NONE) {
      line("fault", describe(device.fault()) + "; hapticctl clear");
    }
    return kDone;
  }
  v1::Error error;
  error.set_code(v1::Error::NOT_FOUND);
  error.set_message("there is no device \"" + name + "\"");
  throw client::NotFound(error);
}

struct Managing {
  const char* verb;
  const char* help;
  v1::ManageDevice::Action action;
  const char* done;
};

constexpr std::array kActions = {
    Managing{"identify", "let it show which one it is: its light blinks", v1::ManageDevice::IDENTIFY,
             "shows which one it is"},
    Managing{"calibrate", "it is in its rest pose now", v1::ManageDevice::CALIBRATE, "is calibrated"},
    Managing{"home", "its position does not count until it has been homed again", v1::ManageDevice::HOME,
             "is to be homed again"},
    Managing{"reopen", "close it, look for it and open it again", v1::ManageDevice::REOPEN,
             "is looked for and opened again"},
};

ExitCode manage(Command& command, const std::string& name, const Managing& managing) {
  const v1::Response response = call(command.connect(), [&](v1::Request& request) {
    request.mutable_manage_device()->set_device(name);
    request.mutable_manage_device()->set_action(managing.action);
  });
  if (command.json) {
    print_json(response.done());
  } else {
    fmt::print("{} {}\n", name, managing.done);
  }
  return kDone;
}

}  // namespace

void add_devices(CLI::App& app, Command& command) {
  CLI::App& devices =
      add_family(app, command, "devices", "the devices, where they are and what they push", list_devices);

  const auto is_watched = std::make_shared<bool>(false);
  CLI::App& list = add_verb(
      devices, command, "list", "all of them, as without a word",
      [is_watched](Command& chosen) { return *is_watched ? watch_devices(chosen) : list_devices(chosen); });
  add_flag(list, "--watch", *is_watched, "and then a line for each change, until it is stopped");

  const auto name = std::make_shared<std::string>();
  CLI::App& show = add_verb(devices, command, "show", "all about one of them",
                            [name](Command& chosen) { return show_device(chosen, *name); });
  add_option(show, "name", *name, "which").required().type("DEVICE");
  for (const Managing& managing : kActions) {
    CLI::App& verb = add_verb(devices, command, managing.verb, managing.help,
                              [name, &managing](Command& chosen) { return manage(chosen, *name, managing); });
    add_option(verb, "name", *name, "which").required().type("DEVICE");
  }
  set_footer(
      devices,
      "Without a further word: list. States: absent (it is looked for), found (but it cannot be opened, or "
      "was\n"
      "lost a moment ago), opening, homing (it must be moved to where its position is known), ready, armed, "
      "FAULT.\n"
      "Why a device is not ready, and how to mend that, is told below the list.");
}

}  // namespace haptic::cli
