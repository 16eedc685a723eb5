#include "client/cli/command.h"

#include <google/protobuf/util/json_util.h>

#include <cstdio>
#include <utility>

namespace haptic::cli {

client::Connection& Command::connect(std::chrono::milliseconds patience) const {
  if (*connection) {
    (*connection)->set_timeout(patience);
    return **connection;
  }
  client::Options options;
  options.address = address;
  options.program = "hapticctl";
  options.timeout = patience;
  *connection = std::make_unique<client::Connection>(options);
  return **connection;
}

void add_common_options(CLI::App& app, Command& command) {
  app.add_flag("--json", command.json, "print protobuf JSON, one object a line");
  app.add_option("--socket", command.address, "the daemon's socket: a path, or host:port")
      ->type_name("ADDRESS");
}

CLI::App* add_verb(CLI::App& parent, Command& command, const std::string& name, const std::string& help,
                   Action action) {
  CLI::App* verb = parent.add_subcommand(name, help);
  add_common_options(*verb, command);
  verb->callback([&command, action = std::move(action)] { command.action = action; });
  return verb;
}

void print_json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string line;
  google::protobuf::util::MessageToJsonString(message, &line, options);
  line += '\n';
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fflush(stdout);
}

v1::Response call(client::Connection& daemon, const std::function<void(v1::Request&)>& fill) {
  v1::Request request;
  fill(request);
  return daemon.call(std::move(request));
}

}  // namespace haptic::cli
