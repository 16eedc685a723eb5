#include "client/plot/curves.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "client/lib/error.h"

namespace haptic::plot {
namespace {

constexpr double kNoForce = 1e-9;  // N
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kPoints = 1000;  // of a curve; a picture is not wider

[[noreturn]] void fail(const std::string& file, const std::string& message) {
  v1::Error error;
  error.set_code(v1::Error::INVALID);
  error.set_file(file);
  error.set_message(message);
  throw client::Invalid(error);
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vector& a) { return std::sqrt(dot(a, a)); }

template <class Value>
Picture over_time(const Forces& all, Value value) {
  Picture picture;
  picture.x_axis = "time [s]";
  for (const auto& [name, forces] : all.by_name) {
    Series series{.name = name, .x = {}, .y = {}};
    series.x.reserve(forces.size());
    series.y.reserve(forces.size());
    for (const auto& [time, sum] : forces) {
      series.x.push_back(time);
      series.y.push_back(value(sum));
    }
    picture.series.push_back(thinned(series, kPoints));
  }
  return picture;
}

// the share of what was counted that lies above each bound
Series tail(const v1::Histogram& histogram, const std::string& name) {
  Series series{.name = name, .x = {}, .y = {}};
  std::uint64_t above = histogram.total();
  const int bins = std::min(histogram.upper_ns_size(), histogram.count_size());
  for (int i = 0; i < bins && above > 0; ++i) {
    above -= std::min(above, histogram.count(i));
    if (above > 0) {
      series.x.push_back(static_cast<double>(histogram.upper_ns(i)) / 1e3);
      series.y.push_back(static_cast<double>(above) / static_cast<double>(histogram.total()));
    }
  }
  return series;
}

std::string state_name(v1::ConstraintState state) {
  std::string name = v1::ConstraintState_Name(state);
  for (std::size_t i = 1; i < name.size(); ++i) {
    name[i] = static_cast<char>(name[i] - 'A' + 'a');
  }
  return name;
}

}  // namespace

Picture force(const Forces& forces) {
  Picture picture = over_time(forces, length);
  switch (forces.of) {
    case Forces::Of::kFingers:
      picture.title = "Force of each finger, before the guard";
      break;
    case Forces::Of::kDevices:
      picture.title = "Force of each device, behind the guard";
      break;
    case Forces::Of::kObjects:
      picture.title = "Force on each object";
      break;
  }
  picture.y_axis = "|F| [N]";
  return picture;
}

Picture friction(const Forces& fingers, const Vector& normal) {
  Picture picture = over_time(fingers, [&normal](const Vector& sum) {
    const double along = dot(sum, normal);
    const Vector across = {sum[0] - along * normal[0], sum[1] - along * normal[1],
                           sum[2] - along * normal[2]};
    return std::abs(along) < kNoForce ? kNothing : length(across) / std::abs(along);
  });
  picture.title = "Tangential over normal force";
  picture.y_axis = "|F_t| / |F_n|";
  return picture;
}

Picture hips(const HipForces& all) {
  Picture picture;
  picture.style = Picture::Style::kImpulses;
  std::ostringstream title;
  title << "Force of each HIP at " << all.time << " s";
  picture.title = title.str();
  picture.x_axis = "HIP";
  picture.y_axis = "|F| [N]";
  for (const auto& [name, forces] : all.by_finger) {
    Series series{.name = name, .x = {}, .y = {}};
    for (const auto& [number, force] : forces) {
      series.x.push_back(number);
      series.y.push_back(length(force));
    }
    picture.series.push_back(std::move(series));
  }
  return picture;
}

Picture transitions(const v1::Stats& stats) {
  Picture picture;
  picture.style = Picture::Style::kBars;
  picture.title = "Transitions of the constraint";
  picture.y_axis = "mean time [ns]";
  Series series;
  for (const v1::TransitionStats& transition : stats.transition()) {
    if (transition.mean_ns() > 0.0) {
      series.x.push_back(static_cast<double>(picture.labels.size()));
      series.y.push_back(transition.mean_ns());
      picture.labels.push_back(state_name(transition.before()) + " to " + state_name(transition.after()));
    }
  }
  picture.series.push_back(std::move(series));
  return picture;
}

Picture latency(const v1::Stats& stats) {
  Picture picture;
  picture.style = Picture::Style::kSteps;
  picture.title = "How many ticks took longer";
  picture.x_axis = "time [us]";
  picture.y_axis = "share of ticks";
  picture.log_x = true;
  picture.log_y = true;
  picture.series.push_back(tail(stats.wakeup(), "wake-up"));
  for (const v1::Histogram& stage : stats.stage()) {
    picture.series.push_back(tail(stage, stage.name()));
  }
  std::erase_if(picture.series, [](const Series& series) { return series.x.empty(); });
  return picture;
}

v1::Stats read_stats(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    fail(path, "cannot be read");
  }
  std::ostringstream text;
  text << file.rdbuf();
  v1::Stats stats;
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;
  const auto status = google::protobuf::util::JsonStringToMessage(text.str(), &stats, options);
  if (!status.ok()) {
    fail(path, "is not what hapticctl --json stats prints: " + std::string(status.message()));
  }
  return stats;
}

}  // namespace haptic::plot
