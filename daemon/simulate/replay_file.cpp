#include "simulate/replay_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "load/error.h"
#include "proto/recording/error.h"
#include "proto/recording/recording.h"
#include "proto/recording/session.h"
#include "replay/replayer.h"

namespace haptic::simulate {

namespace {

// states are few, and where each belongs is told by its tick
std::vector<v1::WorldState> read_states(const recording::Recording& recording) {
  std::vector<v1::WorldState> states;
  for (auto messages = recording.messages({.topics = {recording::kStateTopic}}); messages.next();) {
    messages.parse(states.emplace_back());
  }
  std::stable_sort(states.begin(), states.end(),
                   [](const v1::WorldState& a, const v1::WorldState& b) { return a.tick() < b.tick(); });
  return states;
}

class FileReplay {
 public:
  explicit FileReplay(const recording::Recording& recording)
      : recording_(recording), states_(read_states(recording)) {
    for (auto messages = recording.messages({.topics = {recording::kSceneTopic}}); messages.next();) {
      v1::SceneDescription scene;
      messages.parse(scene);
      replayer_.add_scene(std::move(scene));
    }
  }

  const replay::Report& run() {
    v1::Frame frame;
    step_look();
    for (auto messages = recording_.messages({.topics = {recording::channel_of(v1::INPUTS)}});
         messages.next();) {
      messages.parse(frame);
      add_looks(frame);
      take(frame);
    }
    return replayer_.report();
  }

 private:
  void take(const v1::Frame& frame) {
    for (; next_state_ < states_.size() && states_[next_state_].tick() < frame.tick(); ++next_state_) {
      replayer_.take(states_[next_state_]);
    }
    replayer_.take(frame);
  }

  // objects and HIPs are of another subscription, and may come some ticks earlier or later
  void add_looks(v1::Frame& frame) {
    while (has_look_ && look_.tick() < frame.tick()) step_look();
    for (; has_look_ && look_.tick() == frame.tick(); step_look()) {
      if (look_.has_objects()) *frame.mutable_objects() = look_.objects();
      if (look_.has_hips()) *frame.mutable_hips() = look_.hips();
    }
  }

  void step_look() {
    has_look_ = looks_.next();
    if (has_look_) looks_.parse(look_);
  }

  const recording::Recording& recording_;
  recording::Messages looks_ =
      recording_.messages({.topics = {recording::channel_of(v1::OBJECTS), recording::channel_of(v1::HIPS)}});
  v1::Frame look_;  // the next of them
  bool has_look_ = false;
  std::vector<v1::WorldState> states_;
  std::size_t next_state_ = 0;
  replay::Replayer replayer_;
};

std::string to_json(const replay::Report& report, const std::string& damage) {
  const auto quoted = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') out.push_back('\\');
      if (static_cast<unsigned char>(c) < 0x20) {
        out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
      } else {
        out.push_back(c);
      }
    }
    return out + "\"";
  };
  std::string gaps;
  for (const replay::Gap& gap : report.gaps) {
    gaps += fmt::format("{}{{\"first_tick\":{},\"last_tick\":{}}}", gaps.empty() ? "" : ",", gap.first_tick,
                        gap.last_tick);
  }
  std::string difference = "null";
  if (report.difference) {
    difference = fmt::format(
        R"({{"tick":{},"scene_revision":{},"recorded":"{:016x}","replayed":"{:016x}","where":{}}})",
        report.difference->tick, report.difference->scene_revision, report.difference->recorded,
        report.difference->replayed, quoted(report.difference->where));
  }
  return fmt::format(
      R"({{"ticks":{},"compared":{},"first_tick":{},"last_tick":{},"unreachable":{},"gaps":[{}],"damage":{},)"
      R"("difference":{}}})",
      report.ticks, report.compared, report.first_tick, report.last_tick, report.unreachable, gaps,
      quoted(damage), difference);
}

std::string in_words(const replay::Report& report, const std::string& damage) {
  std::string text;
  if (!damage.empty()) text += fmt::format("the file is not whole: {}\n", damage);
  for (const replay::Gap& gap : report.gaps) {
    text += fmt::format("the inputs of ticks {} to {} are missing\n", gap.first_tick, gap.last_tick);
  }
  if (report.unreachable > 0) {
    text += fmt::format("{} ticks cannot be replayed because of what is missing before them\n",
                        report.unreachable);
  }
  if (report.difference) {
    const replay::Difference& difference = *report.difference;
    text +=
        fmt::format("tick {} differs, the first of {}: state {:016x}, recorded {:016x} (scene revision {})\n",
                    difference.tick, report.compared, difference.replayed, difference.recorded,
                    difference.scene_revision);
    if (!difference.where.empty()) text += difference.where + "\n";
  } else {
    text += fmt::format("{} ticks, {} to {}: the same to the bit\n", report.compared, report.first_tick,
                        report.last_tick);
  }
  return text;
}

bool replay_recording(const ReplayOptions& options, std::ostream& out) {
  const recording::FileSource file(options.file);
  const recording::Recording recording(file);
  FileReplay file_replay(recording);
  const replay::Report& report = file_replay.run();
  if (report.compared == 0 && !report.difference) {
    throw std::runtime_error(options.file +
                             ": has nothing to replay: no state with the inputs of later ticks");
  }
  out << (options.json ? to_json(report, recording.damage()) + "\n" : in_words(report, recording.damage()));
  return !report.difference;
}

}  // namespace

bool replay(const ReplayOptions& options, std::ostream& out) {
  try {
    return replay_recording(options, out);
  } catch (const load::LoadError& error) {
    throw std::runtime_error(options.file + ": " + error.what());
  } catch (const recording::FormatError& error) {
    throw std::runtime_error(options.file + ": " + error.what());
  }
}

}  // namespace haptic::simulate
