#pragma once
// What one run of hapticctl is: the options that every verb has, the verb that was chosen, and how it speaks.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "client/cli/exit_code.h"
#include "client/cli/parser.h"
#include "client/lib/connection.h"

namespace haptic::cli {

struct Command;
using Action = std::function<ExitCode(Command&)>;

/// The connection of a whole run, made when it is first needed.
using SharedConnection = std::shared_ptr<std::unique_ptr<client::Connection>>;

/// How a verb that runs beside a script is ended, and whom it tells that it does its work.
struct Background {
  std::stop_token stop;
  std::function<void()> begun;
};

struct Command {
  std::string address;  // --socket
  std::string server;   // --server
  client::Identity identity;
  bool json = false;                     // --json
  Action action;                         // of the verb that was chosen
  std::optional<Background> background;  // only of a verb that a script has started
  SharedConnection connection = std::make_shared<std::unique_ptr<client::Connection>>();

  /// `patience`: for connecting, and for each answer. The verbs of a script share one connection. Throws
  /// client::Error.
  client::Connection& connect(std::chrono::milliseconds patience = std::chrono::seconds(10)) const;
};

/// Adds a verb that runs `action`. It has the common options as hapticctl itself does, so that they may
/// stand on either side of the verb.
CLI::App& add_verb(CLI::App& parent, Command& command, const std::string& name, const std::string& help,
                   Action action);

/// Adds a verb that has others below it, and the common options.
CLI::App& add_family(CLI::App& parent, Command& command, const std::string& name, const std::string& help);
/// The same, but without another verb it runs `alone`.
CLI::App& add_family(CLI::App& parent, Command& command, const std::string& name, const std::string& help,
                     Action alone);

/// Adds --json, and where the daemon is.
void add_common_options(CLI::App& app, Command& command);

/// Tells what is wrong on standard error; returns `code`.
ExitCode complain(ExitCode code, const std::string& message);

/// One line of JSON with the schema's field names; fields that are zero are told, too.
void print_json(const google::protobuf::Message& message);

/// Sends an empty request of the chosen call and returns the response.
v1::Response call(client::Connection& daemon, const std::function<void(v1::Request&)>& fill);

}  // namespace haptic::cli
