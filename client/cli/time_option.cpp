#include "client/cli/time_option.h"

#include <fmt/format.h>

#include <cmath>

namespace haptic::cli {
namespace {

constexpr double kLongestTime = 1e9;  // s

// replaces the text by its seconds; returns what is wrong with it
std::string to_seconds(std::string& text) {
  std::string number = text;
  double unit = 1.0;
  if (number.ends_with("ms")) {
    number.resize(number.size() - 2);
    unit = 1e-3;
  } else if (number.ends_with("s")) {
    number.pop_back();
  }
  double value = 0.0;
  if (!read_number(number, value) || !std::isfinite(value) || value < 0.0 || value * unit > kLongestTime) {
    return "'" + text + "' is no time: 2s, 2 or 200ms is expected";
  }
  text = fmt::format("{}", value * unit);
  return "";
}

}  // namespace

void add_time(CLI::App& verb, const std::string& name, std::optional<double>& seconds,
              const std::string& help) {
  add_option(verb, name, seconds, help).transform(to_seconds).type("TIME");
}

}  // namespace haptic::cli
