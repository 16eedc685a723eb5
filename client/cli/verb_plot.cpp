#include <cmath>
#include <map>
#include <optional>

#include "client/cli/verbs.h"
#include "client/plot/curves.h"

namespace haptic::cli {
namespace {

enum class Kind { kForce, kFriction, kHips, kTransitions, kLatency };

struct PlotOptions {
  Kind kind = Kind::kForce;
  std::string input;
  std::string output;
  std::string title;
  std::optional<double> time;
  std::vector<double> normal = {0.0, 1.0, 0.0};
  std::vector<unsigned> size = {720, 400};
};

std::array<double, 3> unit(const std::vector<double>& direction) {
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

plot::Picture picture_of(const PlotOptions& options) {
  switch (options.kind) {
    case Kind::kFriction:
      return plot::friction(plot::Csv::read(options.input), unit(options.normal));
    case Kind::kHips:
      return plot::hips(plot::Csv::read(options.input), options.time);
    case Kind::kTransitions:
      return plot::transitions(plot::read_stats(options.input));
    case Kind::kLatency:
      return plot::latency(plot::read_stats(options.input));
    default:
      return plot::force(plot::Csv::read(options.input));
  }
}

ExitCode plot_file(const PlotOptions& options) {
  plot::Picture picture = picture_of(options);
  if (!options.title.empty()) {
    picture.title = options.title;
  }
  plot::draw(picture, options.output, {.width = options.size[0], .height = options.size[1]});
  return kDone;
}

}  // namespace

void add_plot(CLI::App& app, Command& command) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* verb = add_verb(app, command, "plot", "draw what a file holds, with gnuplot",
                            [options](Command&) { return plot_file(*options); });
  const std::map<std::string, Kind> kinds = {{"force", Kind::kForce},
                                             {"friction", Kind::kFriction},
                                             {"hips", Kind::kHips},
                                             {"transitions", Kind::kTransitions},
                                             {"latency", Kind::kLatency}};
  verb->add_option(
          "kind", options->kind,
          "force over time; friction: tangential over normal force; hips: force of each HIP at a time; "
          "transitions and latency: mean times, and how many ticks took longer")
      ->required()
      ->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case).description(""))
      ->type_name("KIND");
  verb->add_option(
          "input", options->input,
          "a CSV file of hapticd simulate; for transitions and latency what hapticctl --json stats printed")
      ->required()
      ->type_name("FILE");
  verb->add_option("-o,--output", options->output, "the picture, .svg or .png")
      ->required()
      ->type_name("FILE");
  verb->add_option("--title", options->title, "instead of one that tells the kind")->type_name("TEXT");
  verb->add_option("--time", options->time, "for hips: the last tick not after it; default: the last of all")
      ->type_name("SECONDS");
  verb->add_option("--normal", options->normal, "for friction: of the surface, in the world; default: 0 1 0")
      ->expected(3)
      ->type_name("X Y Z");
  verb->add_option("--size", options->size, "in pixels; default: 720 400")
      ->expected(2)
      ->check(CLI::Range(100U, 10000U).description(""))
      ->type_name("WIDTH HEIGHT");
}

}  // namespace haptic::cli
