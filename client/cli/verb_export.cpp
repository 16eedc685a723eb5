#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "client/cli/describe.h"
#include "client/cli/time_option.h"
#include "client/cli/verbs.h"
#include "client/export/export.h"
#include "proto/csv/csv_file.h"
#include "proto/recording/error.h"

namespace haptic::cli {
namespace {

using exporting::Format;
using exporting::Topic;

struct ExportOptions {
  std::string recording;
  std::vector<Topic> topics;
  std::optional<double> from;  // s since the recording's start
  std::optional<double> to;
  std::string output;
  bool force = false;
};

std::uint64_t nanoseconds_of(double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds * 1e9));
}

void report(const Command& command, const ExportOptions& options,
            const std::vector<std::pair<Topic, std::uint64_t>>& tables) {
  if (!command.json) {
    for (const auto& [topic, rows] : tables) {
      fmt::print("{}: {}\n", exporting::name_of(topic), count_of(rows, "row"));
    }
    return;
  }
  google::protobuf::Struct told;
  (*told.mutable_fields())["file"].set_string_value(options.output);
  auto& rows_of = *(*told.mutable_fields())["rows"].mutable_struct_value()->mutable_fields();
  for (const auto& [topic, rows] : tables) {
    rows_of[std::string(exporting::name_of(topic))].set_number_value(static_cast<double>(rows));
  }
  print_json(told);
}

ExitCode write_tables(const Command& command, const ExportOptions& options) {
  exporting::Plan plan{.topics = options.topics,
                       .from_ns = nanoseconds_of(options.from.value_or(0.0)),
                       .file = options.output,
                       .format = options.output.ends_with(".csv") ? Format::kCsv : Format::kHdf5};
  if (options.to) {
    plan.to_ns = nanoseconds_of(*options.to);
  }
  const recording::FileSource source(options.recording);
  const recording::Recording recording(source);
  if (!recording.damage().empty()) {
    complain(kDone, options.recording + ": " + recording.damage() + "; what could be read is exported");
  }
  report(command, options, exporting::export_tables(recording, plan));
  return kDone;
}

ExitCode run_export(const Command& command, const ExportOptions& options) {
  if (!std::filesystem::exists(options.recording)) {
    return complain(kNotFound, "there is no " + options.recording);
  }
  if (options.output.ends_with(".csv") && options.topics.size() != 1) {
    return complain(kUsage, "a CSV file holds one topic: choose it by --topic, or export to a .h5");
  }
  if (options.to && *options.to <= options.from.value_or(0.0)) {
    return complain(kUsage,
                    fmt::format("--to {} is not after --from {}", *options.to, options.from.value_or(0.0)));
  }
  if (!options.force && std::filesystem::exists(options.output)) {
    return complain(kFailed, options.output + " is there already; --force replaces it");
  }
  try {
    return write_tables(command, options);
  } catch (const exporting::Missing& error) {
    return complain(kNotFound, options.recording + ": " + error.what());
  } catch (const recording::FormatError& error) {
    return complain(kFailed, options.recording + ": " + error.what());
  }
}

}  // namespace

void add_export(CLI::App& app, Command& command) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App& verb = add_verb(app, command, "export", "a recording as a table for other programs: CSV or HDF5",
                            [options](Command& chosen) { return run_export(chosen, *options); });
  add_option(verb, "recording", options->recording, "a .mcap").required().type("FILE");
  Words<Topic> topics;
  for (const Topic topic : {Topic::kHips, Topic::kObjects, Topic::kDevices, Topic::kContacts, Topic::kEvents,
                            Topic::kStats, Topic::kGaps}) {
    topics.emplace(exporting::name_of(topic), topic);
  }
  add_choices(verb, "--topic", options->topics,
              "hips, objects, devices, contacts, events, stats, gaps; default: all that the recording has",
              topics)
      .type("TOPIC")
      .separated_by(',');
  add_time(verb, "--from", options->from, "only what is so long after the recording's start, or later");
  add_time(verb, "--to", options->to, "only what is before that");
  add_option(verb, "-o,--output", options->output,
             "a .csv, which holds one topic, or a .h5, with a group for each")
      .required()
      .type("FILE")
      .check([](const std::string& text) {
        const bool good = text.ends_with(".csv") || text.ends_with(".h5") || text.ends_with(".hdf5");
        return good ? std::string() : "'" + text + "' ends in neither .csv nor .h5";
      });
  add_flag(verb, "--force", options->force, "replace the file if there is one");
}

}  // namespace haptic::cli
