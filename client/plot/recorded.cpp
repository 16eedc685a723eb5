#include "client/plot/recorded.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "client/export/export.h"
#include "client/export/frame_rows.h"

namespace haptic::plot {
namespace {

using exporting::Topic;
using recording::Recording;

constexpr std::uint64_t kEnd = std::numeric_limits<std::uint64_t>::max();

Topic topic_of(Forces::Of of) {
  switch (of) {
    case Forces::Of::kDevices:
      return Topic::kDevices;
    case Forces::Of::kObjects:
      return Topic::kObjects;
    case Forces::Of::kFingers:
      break;
  }
  return Topic::kHips;
}

void expect(const Recording& recording, Topic topic) {
  const std::vector<Topic> available = exporting::topics_in(recording);
  if (std::find(available.begin(), available.end(), topic) == available.end()) {
    throw exporting::Missing("the recording has no " + std::string(exporting::name_of(topic)));
  }
}

// log_time in ns of so many s after the start
std::uint64_t log_time(const Recording& recording, double seconds) {
  const std::uint64_t start = recording.statistics().start_time;
  const double nanoseconds = seconds * 1e9;
  if (!(nanoseconds > 0.0)) {
    return seconds < 0.0 ? 0 : start;
  }
  return nanoseconds < static_cast<double>(kEnd - start)
             ? start + static_cast<std::uint64_t>(std::llround(nanoseconds))
             : kEnd;
}

// s after the start; frames that others overtook may have been published before it
double seconds_of(const Recording& recording, const recording::Message& message) {
  const std::uint64_t start = recording.statistics().start_time;
  return message.publish_time >= start ? static_cast<double>(message.publish_time - start) * 1e-9
                                       : -static_cast<double>(start - message.publish_time) * 1e-9;
}

// takes the cells that a picture needs of rows of hips, devices or objects
class ForceCells : public exporting::TableWriter {
 public:
  using Use = std::function<void(const std::string& name, std::uint64_t hip, const Vector& force)>;

  ForceCells(Topic topic, Use use) : use_(std::move(use)) {
    std::size_t cell = 0;
    for (const exporting::Column& column : exporting::columns_of(topic)) {
      const std::string_view name = column.name;
      if (name == "force") {
        force_begin_ = cell;
      } else if (name == "hip") {
        hip_cell_ = cell;
      } else if (name_cell_ == kNone && column.kind == exporting::Kind::kName) {
        name_cell_ = cell;  // the first name of a row is whose it is
      }
      cell += exporting::width_of(column);
    }
  }

  void add(std::uint64_t count) override {
    if (cell_ == hip_cell_) {
      hip_ = count;
    }
    ++cell_;
  }
  void add(double number) override {
    if (cell_ >= force_begin_ && cell_ - force_begin_ < force_.size()) {
      force_.at(cell_ - force_begin_) = number;
    }
    ++cell_;
  }
  void add(bool /*flag*/) override { ++cell_; }
  void add(std::string_view text) override {
    if (cell_ == name_cell_) {
      name_ = text;
    }
    ++cell_;
  }
  void end_row() override {
    use_(name_, hip_, force_);
    cell_ = 0;
  }
  void close() override {}

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  Use use_;
  std::size_t name_cell_ = kNone;
  std::size_t hip_cell_ = kNone;
  std::size_t force_begin_ = kNone;
  std::size_t cell_ = 0;
  std::string name_;
  std::uint64_t hip_ = 0;
  Vector force_{};
};

void add(const Vector& force, Vector& sum) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sum[axis] += force[axis];
  }
}

struct Found {
  v1::Frame frame;
  double time = 0.0;  // s
};

// The last frame of a topic that was recorded from `from` up to before `to`. It is looked for from the end,
// in ever longer stretches, as whatever is read has to be decompressed.
std::optional<Found> last_frame(const Recording& recording, Topic topic, std::uint64_t from,
                                std::uint64_t to) {
  const std::uint64_t last = recording.statistics().end_time;
  to = to > last && last < kEnd ? last + 1 : to;
  for (std::uint64_t stretch = 1'000'000'000;; stretch *= 16) {
    const bool is_all = to <= from || to - from <= stretch || stretch > kEnd / 16;
    std::optional<Found> found;
    auto messages = recording.messages(
        {.topics = {exporting::channel_of(topic)}, .from = is_all ? from : to - stretch, .to = to});
    while (messages.next()) {
      found.emplace();
      messages.parse(found->frame);
      found->time = seconds_of(recording, messages.message());
    }
    if (found || is_all) {
      return found;
    }
  }
}

}  // namespace

bool is_recording(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic(recording::kMagic.size(), '\0');
  file.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  return file && magic == recording::kMagic;
}

Forces::Of first_of(const Recording& recording) {
  const std::vector<Topic> available = exporting::topics_in(recording);
  for (const Forces::Of of : {Forces::Of::kFingers, Forces::Of::kDevices, Forces::Of::kObjects}) {
    if (std::find(available.begin(), available.end(), topic_of(of)) != available.end()) {
      return of;
    }
  }
  throw exporting::Missing("the recording has neither hips nor devices nor objects");
}

Forces forces_of(const Recording& recording, Forces::Of of, const Span& span) {
  const Topic topic = topic_of(of);
  expect(recording, topic);
  const exporting::Naming naming = exporting::naming_of(recording);
  Forces forces{.of = of};
  double time = 0.0;
  std::map<std::string, Vector> sums;  // of one frame
  ForceCells cells(topic, [&](const std::string& name, std::uint64_t /*hip*/, const Vector& force) {
    add(force, sums[name]);
  });
  auto messages = recording.messages({.topics = {exporting::channel_of(topic)},
                                      .from = log_time(recording, span.from),
                                      .to = log_time(recording, span.to)});
  v1::Frame frame;
  while (messages.next()) {
    messages.parse(frame);
    time = seconds_of(recording, messages.message());
    sums.clear();
    exporting::add_rows(topic, frame, naming, cells);
    for (const auto& [name, sum] : sums) {
      forces.by_name[name][time] = sum;
    }
  }
  return forces;
}

HipForces hip_forces_of(const Recording& recording, std::optional<double> time) {
  expect(recording, Topic::kHips);
  const std::uint64_t to = time ? log_time(recording, *time) : kEnd;
  const std::optional<Found> found = last_frame(recording, Topic::kHips, 0, to == kEnd ? to : to + 1);
  if (!found) {
    throw exporting::Missing("the recording has no hips as early as that");
  }
  HipForces forces{.time = found->time};
  ForceCells cells(Topic::kHips, [&](const std::string& finger, std::uint64_t hip, const Vector& force) {
    add(force, forces.by_finger[finger][static_cast<double>(hip)]);
  });
  exporting::add_rows(Topic::kHips, found->frame, exporting::naming_of(recording), cells);
  return forces;
}

v1::Stats stats_of(const Recording& recording, const Span& span) {
  expect(recording, Topic::kStats);
  const std::optional<Found> found =
      last_frame(recording, Topic::kStats, log_time(recording, span.from), log_time(recording, span.to));
  if (!found) {
    throw exporting::Missing("the recording has no stats of that time");
  }
  return found->frame.stats();
}

}  // namespace haptic::plot
