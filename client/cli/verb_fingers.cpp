#include <fmt/format.h>

#include "client/cli/look.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

void print_fingers(const Look& look) {
  for (const FingerSummary& finger : summarise_fingers(look.names, look.frame.hips())) {
    google::protobuf::Struct line;
    auto& fields = *line.mutable_fields();
    fields["name"] = json(finger.name);
    fields["device"] = json(finger.device);
    fields["hips"] = json(finger.hips);
    fields["contacts"] = json(finger.contacts);
    fields["slipping"] = json(finger.slipping);
    for (const double component : finger.force) {
      *fields["force"].mutable_list_value()->add_values() = json(component);
    }
    print_json(line);
  }
}

ExitCode show_fingers(Command& command, bool hips) {
  client::Connection& daemon = command.connect();
  const Look look = look_once(daemon, v1::HIPS);
  if (command.json) {
    print_fingers(look);
    return kDone;
  }
  const std::string table = fingers_table(look.names, look.frame.hips());
  fmt::print("{}", table.empty() ? "the scene has no fingers\n" : table);
  if (hips) {
    const std::string rows = hips_table(look.names, look.frame.hips());
    fmt::print("\n{}", rows.empty() ? "no HIP is in contact\n" : rows);
  }
  return kDone;
}

}  // namespace

void add_fingers(CLI::App& app, Command& command) {
  const auto hips = std::make_shared<bool>(false);
  CLI::App& verb = add_verb(app, command, "fingers", "the fingers and what they feel now",
                            [hips](Command& chosen) { return show_fingers(chosen, *hips); });
  add_flag(verb, "--hips", *hips, "each HIP in contact, too");
}

}  // namespace haptic::cli
