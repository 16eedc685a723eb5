#include "client/cli/command.h"

#include <google/protobuf/util/json_util.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace haptic::cli {

namespace {

std::string or_environment(const std::string& value, const char* name) {
  const char* const set = value.empty() ? std::getenv(name) : nullptr;
  return set == nullptr ? value : set;
}

}  // namespace

client::Connection& Command::connect(std::chrono::milliseconds patience) const {
  if (*connection) {
    (*connection)->set_timeout(patience);
    return **connection;
  }
  client::Options options;
  options.address = address;
  if (address.empty()) {
    options.address = or_environment(server, "HAPTICD_SERVER");
    if (!options.address.empty() && !client::parse_address(options.address).path.empty()) {
      v1::Error error;
      error.set_code(v1::Error::INVALID);
      error.set_message("\"" + options.address + "\" is no server; host:port is expected");
      throw client::Invalid(error);
    }
  }
  options.identity = {or_environment(identity.certificate, "HAPTICD_CERTIFICATE"),
                      or_environment(identity.key, "HAPTICD_KEY"),
                      or_environment(identity.authority, "HAPTICD_AUTHORITY")};
  options.program = "hapticctl";
  options.timeout = patience;
  *connection = std::make_unique<client::Connection>(options);
  return **connection;
}

void add_common_options(CLI::App& app, Command& command) {
  add_flag(app, "--json", command.json, "print protobuf JSON, one object a line");
  add_option(app, "--socket", command.address, "the daemon's socket: a path, or host:port").type("ADDRESS");
  add_option(app, "--server", command.server, "a daemon elsewhere: host:port").type("ADDRESS");
  add_option(app, "--certificate", command.identity.certificate, "for TLS: your certificate").type("FILE");
  add_option(app, "--key", command.identity.key, "for TLS: its key").type("FILE");
  add_option(app, "--authority", command.identity.authority,
             "for TLS: who must have signed the daemon's certificate")
      .type("FILE");
}

CLI::App& add_verb(CLI::App& parent, Command& command, const std::string& name, const std::string& help,
                   Action action) {
  CLI::App& verb =
      add_verb(parent, name, help, [&command, action = std::move(action)] { command.action = action; });
  add_common_options(verb, command);
  return verb;
}

CLI::App& add_family(CLI::App& parent, Command& command, const std::string& name, const std::string& help) {
  CLI::App& family = add_family(parent, name, help);
  add_common_options(family, command);
  return family;
}

CLI::App& add_family(CLI::App& parent, Command& command, const std::string& name, const std::string& help,
                     Action alone) {
  CLI::App& family =
      add_family(parent, name, help, [&command, action = std::move(alone)] { command.action = action; });
  add_common_options(family, command);
  return family;
}

ExitCode complain(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "hapticctl: %s\n", message.c_str());
  return code;
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
