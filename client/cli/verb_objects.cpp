#include <fmt/format.h>

#include "client/cli/look.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

void print_objects(const Look& look) {
  const v1::ObjectsFrame& objects = look.frame.objects();
  for (int i = 0; i < static_cast<int>(look.names.objects.size()); ++i) {
    google::protobuf::Struct line;
    auto& fields = *line.mutable_fields();
    fields["name"] = json(look.names.objects[static_cast<std::size_t>(i)]);
    fields["position"] = json_item(objects.position(), 3, i);
    fields["orientation"] = json_item(objects.orientation(), 4, i);
    fields["velocity"] = json_item(objects.velocity(), 3, i);
    fields["angular_velocity"] = json_item(objects.angular_velocity(), 3, i);
    fields["force"] = json_item(objects.force(), 3, i);
    fields["torque"] = json_item(objects.torque(), 3, i);
    print_json(line);
  }
}

ExitCode show_objects(Command& command) {
  client::Connection& daemon = command.connect();
  const Look look = look_once(daemon, v1::OBJECTS);
  if (command.json) {
    print_objects(look);
    return kDone;
  }
  const std::string table = objects_table(look.names, look.frame.objects());
  fmt::print("{}", table.empty() ? "the scene has no objects\n" : table);
  return kDone;
}

}  // namespace

void add_objects(CLI::App& app, Command& command) {
  add_verb(app, command, "objects", "the objects and where they are now", show_objects);
}

}  // namespace haptic::cli
