#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "client/cli/time_option.h"
#include "client/cli/verbs.h"
#include "client/export/export.h"
#include "client/plot/curves.h"
#include "client/plot/recorded.h"
#include "proto/recording/error.h"

namespace haptic::cli {
namespace {

enum class Kind { kForce, kFriction, kHips, kTransitions, kLatency };

struct PlotOptions {
  Kind kind = Kind::kForce;
  std::string input;
  std::string output;
  std::string title;
  std::optional<double> at;  // s
  std::optional<double> from;
  std::optional<double> to;
  std::optional<plot::Forces::Of> of;
  std::vector<double> normal = {0.0, 1.0, 0.0};
  std::vector<unsigned> size = {720, 400};
};

bool is_of_stats(Kind kind) { return kind == Kind::kTransitions || kind == Kind::kLatency; }

// what is wrong with the options together; empty: nothing
std::string conflict_of(const PlotOptions& options, bool is_recording) {
  if (options.at && options.kind != Kind::kHips) {
    return "--at is for hips";
  }
  if ((options.from || options.to) && options.kind == Kind::kHips) {
    return "--from and --to are not for hips, which have --at";
  }
  if ((options.from || options.to) && !is_recording && is_of_stats(options.kind)) {
    return "--from and --to are not for one message of stats";
  }
  if (options.of && (options.kind != Kind::kForce || !is_recording)) {
    return "--topic is for the force in a recording";
  }
  if (options.to && *options.to <= options.from.value_or(0.0)) {
    return fmt::format("--to {} is not after --from {}", *options.to, options.from.value_or(0.0));
  }
  return "";
}

plot::Vector unit(const std::vector<double>& direction) {
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  if (!(length > 0.0) || !std::isfinite(length)) {
    v1::Error error;
    error.set_code(v1::Error::INVALID);
    error.set_field("--normal");
    error.set_message("a direction has a length");
    throw client::Invalid(error);
  }
  return {direction[0] / length, direction[1] / length, direction[2] / length};
}

plot::Span span_of(const PlotOptions& options) {
  plot::Span span;
  span.from = options.from.value_or(span.from);
  span.to = options.to.value_or(span.to);
  return span;
}

plot::Picture picture_of_file(const PlotOptions& options) {
  if (options.kind == Kind::kTransitions) {
    return plot::transitions(plot::read_stats(options.input));
  }
  if (options.kind == Kind::kLatency) {
    return plot::latency(plot::read_stats(options.input));
  }
  const plot::Csv table = plot::Csv::read(options.input);
  if (options.kind == Kind::kHips) {
    return plot::hips(plot::hip_forces_of(table, options.at));
  }
  if (options.kind == Kind::kFriction) {
    return plot::friction(plot::forces_of(table, plot::Forces::Of::kFingers, span_of(options)),
                          unit(options.normal));
  }
  return plot::force(plot::forces_of(table, plot::first_of(table), span_of(options)));
}

plot::Picture picture_of_recording(const PlotOptions& options) {
  const recording::FileSource source(options.input);
  const recording::Recording recording(source);
  if (!recording.damage().empty()) {
    complain(kDone, options.input + ": " + recording.damage() + "; what could be read is drawn");
  }
  const plot::Span span = span_of(options);
  switch (options.kind) {
    case Kind::kFriction:
      return plot::friction(plot::forces_of(recording, plot::Forces::Of::kFingers, span),
                            unit(options.normal));
    case Kind::kHips:
      return plot::hips(plot::hip_forces_of(recording, options.at));
    case Kind::kTransitions:
      return plot::transitions(plot::stats_of(recording, span));
    case Kind::kLatency:
      return plot::latency(plot::stats_of(recording, span));
    case Kind::kForce:
      break;
  }
  return plot::force(plot::forces_of(recording, options.of ? *options.of : plot::first_of(recording), span));
}

ExitCode plot_file(const PlotOptions& options) {
  const bool is_recording = plot::is_recording(options.input);
  if (const std::string conflict = conflict_of(options, is_recording); !conflict.empty()) {
    return complain(kUsage, conflict);
  }
  try {
    plot::Picture picture = is_recording ? picture_of_recording(options) : picture_of_file(options);
    if (!options.title.empty()) {
      picture.title = options.title;
    }
    plot::draw(picture, options.output, {.width = options.size[0], .height = options.size[1]});
    return kDone;
  } catch (const exporting::Missing& error) {
    return complain(kNotFound, options.input + ": " + error.what());
  } catch (const recording::FormatError& error) {
    return complain(kFailed, options.input + ": " + error.what());
  }
}

void add_options(CLI::App& verb, PlotOptions& options) {
  const Words<plot::Forces::Of> topics = {{"hips", plot::Forces::Of::kFingers},
                                          {"devices", plot::Forces::Of::kDevices},
                                          {"objects", plot::Forces::Of::kObjects}};
  add_option(verb, "-o,--output", options.output, "the picture, .svg or .png").required().type("FILE");
  add_option(verb, "--title", options.title, "instead of one that tells the kind").type("TEXT");
  add_choice(verb, "--topic", options.of,
             "for the force in a recording: of fingers, devices or objects; default: the first that it has",
             topics)
      .type("hips|devices|objects");
  add_time(verb, "--at", options.at, "for hips: the last tick not after it; default: the last of all");
  add_time(verb, "--from", options.from, "only what is at this time or later; 2s, 2 or 200ms");
  add_time(verb, "--to", options.to, "only what is before that");
  add_option(verb, "--normal", options.normal, "for friction: of the surface, in the world; default: 0 1 0")
      .values(3)
      .type("X Y Z");
  add_option(verb, "--size", options.size, "in pixels; default: 720 400")
      .values(2)
      .between(100U, 10000U)
      .type("WIDTH HEIGHT");
}

}  // namespace

void add_plot(CLI::App& app, Command& command) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App& verb = add_verb(app, command, "plot", "draw what a file holds, with gnuplot",
                            [options](Command&) { return plot_file(*options); });
  const Words<Kind> kinds = {{"force", Kind::kForce},
                             {"friction", Kind::kFriction},
                             {"hips", Kind::kHips},
                             {"transitions", Kind::kTransitions},
                             {"latency", Kind::kLatency}};
  add_choice(verb, "kind", options->kind,
             "force over time; friction: tangential over normal force; hips: force of each HIP at a time; "
             "transitions and latency: mean times, and how many ticks took longer",
             kinds)
      .required()
      .type("force|friction|hips|transitions|latency");
  add_option(verb, "input", options->input,
             "a recording (.mcap), whose times are since its start; or a CSV file of hapticd simulate, for "
             "transitions and latency what hapticctl --json stats printed")
      .required()
      .type("FILE");
  add_options(verb, *options);
}

}  // namespace haptic::cli
