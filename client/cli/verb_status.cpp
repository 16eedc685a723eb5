#include <fmt/format.h>

#include "client/cli/describe.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

void say(const char* what, const std::string& value) { fmt::print("{:<13} {}\n", what, value); }

ExitCode show_status(Command& command) {
  client::Connection& daemon = command.connect();
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_get_status(); });
  const v1::Status& status = response.status();
  if (command.json) {
    print_json(status);
    return kDone;
  }
  say("daemon", fmt::format("hapticd {}, up {}", status.version(), duration(status.uptime())));
  say("forces", status.armed() ? "armed" : "disarmed");
  say("drive lease", status.has_drive_holder() ? describe(status.drive_holder()) : "free");
  for (const v1::Fault& fault : status.fault()) {
    say("fault", describe(fault) + "; hapticctl clear");
  }
  say("clock", fmt::format("{:.6g} Hz, tick {}, {} missed{}", status.rate_hz(), status.tick(),
                           status.missed_ticks(), status.paused() ? ", PAUSED" : ""));
  say("scene",
      fmt::format("{} (revision {}): {}, {}, {}", status.scene().empty() ? "without a name" : status.scene(),
                  status.scene_revision(), count_of(status.objects(), "object"),
                  count_of(status.fingers(), "finger"), count_of(status.hips(), "HIP")));
  say("devices", fmt::format("{}", status.devices()));
  say("clients", fmt::format("{}", status.clients()));
  say("real time", describe(status.real_time()));
  for (const std::string& warning : status.real_time().warning()) {
    say("", warning);
  }
  return kDone;
}

}  // namespace

void add_status(CLI::App& app, Command& command) {
  add_verb(app, command, "status", "how the daemon is", show_status);
}

}  // namespace haptic::cli
