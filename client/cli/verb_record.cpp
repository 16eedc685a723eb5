#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "client/cli/describe.h"
#include "client/cli/inputs_recorder.h"
#include "client/cli/look.h"
#include "client/cli/screen.h"
#include "client/cli/verbs.h"
#include "proto/recording/error.h"
#include "proto/recording/session.h"

namespace haptic::cli {
namespace {

using SteadyClock = std::chrono::steady_clock;
using recording::FileSink;

// what has happened before the end is taken for so long
constexpr std::chrono::seconds kDrain{2};

// a chunk is written at least so often, and the line on the terminal
constexpr std::chrono::milliseconds kWritePeriod{500};

struct RecordOptions {
  std::string file;
  std::vector<v1::Topic> topics;
  std::uint32_t decimation = 1;
  double seconds = 0.0;  // 0: until stopped
  bool replace = false;
  bool no_viewers = false;
  bool no_inputs = false;
};

// what has come in
struct Counts {
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;
  std::uint64_t gaps = 0;
};

class Recorder {
 public:
  Recorder(Command& command, const RecordOptions& options)
      : json_(command.json),
        live_(!command.json && !command.background && is_terminal()),
        background_(command.background.value_or(Background())),
        options_(options),
        daemon_(command.connect()),
        sink_(options.file, options.replace ? FileSink::IfThere::kReplace : FileSink::IfThere::kRefuse,
              FileSink::Durable::kYes) {}

  // Whatever ends the recording, the file is closed as well as it can be, and told of.
  ExitCode run() {
    catch_stop_signals();
    std::exception_ptr failure;
    try {
      begin();
      record();
      drain();
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    try {
      end();
    } catch (const recording::IoError&) {
      failure = failure ? failure : std::current_exception();
    }
    tell_result();
    if (failure) {
      std::rethrow_exception(failure);
    }
    if (!is_stopped()) {
      daemon_.unsubscribe(subscription_);  // a script goes on with this connection
      if (inputs_) {
        inputs_->end();
      }
    }
    return kDone;
  }

 private:
  void begin() {
    const v1::Response status = call(daemon_, [](v1::Request& request) { request.mutable_get_status(); });
    writer_.emplace(sink_, recording::Session{.program = "hapticctl " HAPTIC_VERSION,
                                              .daemon_version = status.status().version(),
                                              .rate_hz = status.status().rate_hz(),
                                              .decimation = options_.decimation,
                                              .viewers = !options_.no_viewers});
    begin_inputs();
    v1::Subscribe wish;
    wish.mutable_topic()->Assign(options_.topics.begin(), options_.topics.end());
    wish.set_decimation(options_.decimation);
    wish.set_delivery(v1::LOSSLESS);
    subscription_ = daemon_.subscribe(wish);
    if (background_.begun) {
      background_.begun();
    }
  }

  bool is_stopped() const { return stop_requested() || background_.stop.stop_requested(); }

  // a recording that cannot be replayed is still worth having
  void begin_inputs() {
    if (options_.no_inputs) {
      not_replayable_ = "--no-inputs";
      return;
    }
    inputs_.emplace(daemon_, *writer_);
    or_without_inputs([this] { inputs_->begin(); });
  }

  template <class Do>
  void or_without_inputs(Do action) {
    try {
      action();
    } catch (const client::Unreachable&) {
      throw;
    } catch (const client::Error& error) {
      not_replayable_ = error.what();
      inputs_.reset();
    }
  }

  void record() {
    const SteadyClock::time_point start = SteadyClock::now();
    SteadyClock::time_point next = start + kWritePeriod;
    while (!is_stopped()) {
      const SteadyClock::time_point now = SteadyClock::now();
      seconds_ = std::chrono::duration<double>(now - start).count();
      if (options_.seconds > 0.0 && seconds_ >= options_.seconds) {
        return;
      }
      if (now >= next) {
        writer_->flush();
        show_progress();
        next = now + kWritePeriod;
      }
      if (const auto message = daemon_.receive(std::chrono::milliseconds(100))) {
        take(*message);
      }
    }
  }

  // Frames wait on both sides of the socket: all of the ticks up to now belong to the recording.
  void drain() {
    const auto is_of_ticks = [](v1::Topic topic) { return topic != v1::EVENTS && topic != v1::STATS; };
    if (std::none_of(options_.topics.begin(), options_.topics.end(), is_of_ticks)) {
      return;
    }
    const v1::Response status = call(daemon_, [](v1::Request& request) { request.mutable_get_status(); });
    const SteadyClock::time_point deadline = SteadyClock::now() + kDrain;
    while (tick_ + options_.decimation <= status.status().tick() && SteadyClock::now() < deadline) {
      if (const auto message = daemon_.receive(std::chrono::milliseconds(20))) {
        take(*message);
      }
    }
  }

  void take(const v1::Envelope& message) {
    bool taken = false;
    if (inputs_) {
      or_without_inputs([&] { taken = inputs_->take(message); });
    }
    if (taken) {
      return;
    }
    if (message.has_frame() && message.frame().subscription() == subscription_) {
      const v1::Frame& frame = message.frame();
      time_ = frame.realtime_ns();
      if (!frame.has_event() && !frame.has_stats()) {
        tick_ = frame.tick();
      }
      if (!scene_revision_ || frame.scene_revision() > *scene_revision_) {
        write_scene(frame.scene_revision());
      }
      writer_->write(frame);
      ++counts_.frames;
    } else if (message.has_gap() && message.gap().subscription() == subscription_) {
      writer_->write(message.gap(), time_);
      counts_.lost += message.gap().last_sequence() - message.gap().first_sequence() + 1;
      ++counts_.gaps;
    }
  }

  // before the first frame that it is for; frames that come meanwhile wait
  void write_scene(std::uint64_t revision) {
    if (!scene_revision_) {
      const v1::Response devices =
          call(daemon_, [](v1::Request& request) { request.mutable_list_devices(); });
      writer_->write(devices.devices(), time_);
    }
    if (inputs_) {
      scene_revision_ = revision;
      or_without_inputs([&] { inputs_->write_scene(revision, time_); });
    }
    if (!inputs_) {
      const v1::Response scene = call(daemon_, [](v1::Request& request) { request.mutable_get_scene(); });
      writer_->write(scene.scene(), time_);
      scene_revision_ = scene.scene().revision();
    }
  }

  void end() {
    if (writer_) {
      writer_->close();
      sink_.close();
    }
  }

  void show_progress() {
    if (!live_) {
      return;
    }
    constexpr double kPeriods = 1.0 / std::chrono::duration<double>(kWritePeriod).count();
    const std::uint64_t size = writer_->writer().size();
    const auto rate = static_cast<double>(counts_.frames - shown_.frames) * kPeriods;
    const auto growth = static_cast<double>(size - shown_size_) * kPeriods;
    fmt::print("\r{}  {} ({:.0f}/s)  {} ({}/s)  {} lost\033[K", duration(seconds_),
               count_of(counts_.frames, "frame"), rate, bytes(size),
               bytes(static_cast<std::uint64_t>(growth)), counts_.lost);
    std::fflush(stdout);
    shown_ = counts_;
    shown_size_ = size;
  }

  void tell_result() const {
    if (!writer_) {
      return;
    }
    const recording::Writer& writer = writer_->writer();
    if (json_) {
      google::protobuf::Struct result;
      auto& fields = *result.mutable_fields();
      fields["file"] = json(options_.file);
      fields["seconds"] = json(seconds_);
      fields["frames"] = json(static_cast<double>(counts_.frames));
      fields["messages"] = json(static_cast<double>(writer.statistics().message_count));
      fields["bytes"] = json(static_cast<double>(writer.size()));
      fields["gaps"] = json(static_cast<double>(counts_.gaps));
      fields["lost_frames"] = json(static_cast<double>(counts_.lost));
      fields["replayable"].set_bool_value(not_replayable_.empty());
      fields["lost_inputs"] = json(static_cast<double>(inputs_ ? inputs_->lost() : 0));
      print_json(result);
      return;
    }
    fmt::print("{}{}: {} in {}, {}; {}\n", live_ ? "\r\033[K" : "", options_.file,
               count_of(counts_.frames, "frame"), duration(seconds_), bytes(writer.size()),
               counts_.lost == 0 ? "none is lost"
                                 : fmt::format("{} lost in {}", count_of(counts_.lost, "frame"),
                                               count_of(counts_.gaps, "gap")));
    if (!not_replayable_.empty()) {
      fmt::print("it cannot be replayed to the bit: {}\n", not_replayable_);
    } else if (inputs_ && inputs_->lost() > 0) {
      fmt::print("the inputs of {} are lost, and the replay goes on after them\n",
                 count_of(inputs_->lost(), "tick"));
    }
    std::fflush(stdout);
  }

  bool json_;
  bool live_;
  Background background_;
  RecordOptions options_;
  client::Connection& daemon_;
  FileSink sink_;
  std::optional<recording::SessionWriter> writer_;
  std::optional<InputsRecorder> inputs_;
  std::string not_replayable_;  // why; empty: it is
  std::uint32_t subscription_ = 0;
  std::optional<std::uint64_t> scene_revision_;
  std::uint64_t tick_ = 0;  // of the newest frame
  std::uint64_t time_ = 0;  // likewise, ns
  double seconds_ = 0.0;
  Counts counts_;
  Counts shown_;
  std::uint64_t shown_size_ = 0;
};

}  // namespace

void add_record(CLI::App& app, Command& command) {
  const auto options = std::make_shared<RecordOptions>();
  options->topics = {v1::OBJECTS, v1::HIPS, v1::DEVICES, v1::EVENTS, v1::STATS};
  CLI::App& verb = add_verb(app, command, "record", "writes what happens to an MCAP file; Ctrl-C ends it",
                            [options](Command& chosen) { return Recorder(chosen, *options).run(); });
  add_option(verb, "file", options->file, "the recording").required().type("FILE");
  add_option(verb, "--seconds", options->seconds, "end after so long").positive();
  const Words<v1::Topic> topics = {{"objects", v1::OBJECTS},
                                   {"hips", v1::HIPS},
                                   {"devices", v1::DEVICES},
                                   {"events", v1::EVENTS},
                                   {"stats", v1::STATS}};
  add_choices(verb, "--topic,--topics", options->topics,
              "objects, hips, devices, events, stats; default: all", topics)
      .type("TOPIC")
      .separated_by(',');
  add_option(verb, "--decimation", options->decimation, "one frame for so many ticks; default: each tick")
      .positive()
      .type("N");
  add_flag(verb, "--replace", options->replace, "the file may be there already; it is lost then");
  add_flag(verb, "--no-inputs", options->no_inputs,
           "without the inputs of each tick, the state and the meshes; it cannot be replayed then");
  add_flag(verb, "--no-viewers", options->no_viewers, "without the topics that are for viewers alone");
}

}  // namespace haptic::cli
