#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "client/cli/describe.h"
#include "client/cli/look.h"
#include "client/cli/screen.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

using SteadyClock = std::chrono::steady_clock;

struct WatchOptions {
  std::vector<v1::Topic> topics;
  std::vector<std::string> fingers;  // none: all
  std::vector<std::string> objects;  // none: all
  bool only_in_contact = false;
  v1::Delivery delivery = v1::DELIVERY_UNSPECIFIED;  // then as the output wants
  double rate = 0.0;                                 // Hz; 0: 20 on a terminal, 1 in lines, each tick in JSON
  double seconds = 0.0;                              // 0: until stopped
  std::uint64_t count = 0;
  bool hips = false;
};

// what has come in, beside the newest frame
struct Progress {
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;
  std::string last_event;
  std::string last_stats;
};

class Watch {
 public:
  Watch(Command& command, const WatchOptions& options)
      : json_(command.json), options_(options), daemon_(command.connect()) {}

  ExitCode run() {
    catch_stop_signals();
    const bool live = !json_ && is_terminal();
    subscribe(live);
    if (live) {
      screen_.emplace();
    }
    const auto start = SteadyClock::now();
    while (!stop_requested() && !enough(start)) {
      if (const auto message = daemon_.receive(std::chrono::milliseconds(100))) {
        take(*message);
      }
    }
    if (!stop_requested()) {
      daemon_.unsubscribe(subscription_);  // a script goes on with this connection
    }
    return kDone;
  }

 private:
  void subscribe(bool live) {
    const v1::Response response = call(daemon_, [](v1::Request& request) { request.mutable_get_status(); });
    rate_hz_ = response.status().rate_hz();
    const double wanted = options_.rate > 0.0 ? options_.rate : json_ ? rate_hz_ : live ? 20.0 : 1.0;
    const auto decimation = static_cast<std::uint32_t>(std::max(1.0, std::round(rate_hz_ / wanted)));
    v1::Subscribe wish;
    wish.mutable_topic()->Assign(options_.topics.begin(), options_.topics.end());
    wish.set_decimation(decimation);
    wish.set_delivery(options_.delivery != v1::DELIVERY_UNSPECIFIED ? options_.delivery
                      : live                                        ? v1::LATEST
                                                                    : v1::LOSSLESS);
    wish.mutable_finger()->Assign(options_.fingers.begin(), options_.fingers.end());
    wish.mutable_object()->Assign(options_.objects.begin(), options_.objects.end());
    wish.set_only_in_contact(options_.only_in_contact);
    subscription_ = daemon_.subscribe(wish);
    if (!json_) {
      ask_for_names();
    }
  }

  // only fingers that were asked for are shown
  void ask_for_names() {
    names_ = ask_names(daemon_);
    if (!options_.fingers.empty()) {
      std::erase_if(names_.fingers, [this](const auto& finger) {
        return std::find(options_.fingers.begin(), options_.fingers.end(), finger.name()) ==
               options_.fingers.end();
      });
    }
  }

  bool has_topic(v1::Topic topic) const {
    return std::find(options_.topics.begin(), options_.topics.end(), topic) != options_.topics.end();
  }

  bool enough(SteadyClock::time_point start) const {
    if (options_.count > 0 && progress_.frames >= options_.count) {
      return true;
    }
    return options_.seconds > 0.0 &&
           std::chrono::duration<double>(SteadyClock::now() - start).count() >= options_.seconds;
  }

  void take(const v1::Envelope& message) {
    if (message.has_event() && has_topic(v1::EVENTS)) {
      return;  // it comes as a frame, too
    }
    if (message.has_frame()) {
      ++progress_.frames;
    }
    if (message.has_gap()) {
      progress_.lost += message.gap().last_sequence() - message.gap().first_sequence() + 1;
    }
    if (json_) {
      // frames as they are; the rare rest says what it is
      print_json(message.has_frame() ? static_cast<const google::protobuf::Message&>(message.frame())
                                     : message);
    } else if (message.has_event() || message.frame().has_event()) {
      show(message.has_event() ? message.event() : message.frame().event());
    } else if (message.has_frame()) {
      show(message.frame());
    }
  }

  void show(const v1::Event& event) {
    progress_.last_event = event.message();
    if (!screen_) {
      fmt::print("tick {}: {}\n", event.tick(), event.message());
      std::fflush(stdout);
    }
  }

  void show(const v1::Frame& frame) {
    if (frame.scene_revision() != names_.scene_revision && !frame.has_stats()) {
      ask_for_names();
    }
    if (frame.has_stats()) {
      progress_.last_stats = times(frame.stats());
    }
    if (!screen_) {
      fmt::print("{}\n", frame.has_stats() ? progress_.last_stats : line(frame));
      std::fflush(stdout);
    } else if (!frame.has_stats()) {
      screen_->show(page(frame));
    }
  }

  static std::string times(const v1::Stats& stats) {
    std::string text =
        fmt::format("tick {}  {} missed", stats.tick(), count_of(stats.missed_ticks(), "tick"));
    for (const v1::Histogram& stage : stats.stage()) {
      if (stage.name() == "tick") {
        text +=
            fmt::format("  a tick takes {:.1f} us, p99 {:.1f} us, at most {:.1f} us", stage.mean_ns() / 1e3,
                        static_cast<double>(stage.p99_ns()) / 1e3, static_cast<double>(stage.max_ns()) / 1e3);
      }
    }
    return text;
  }

  std::string page(const v1::Frame& frame) const {
    std::string text =
        fmt::format("tick {}  {:.6g} Hz  {}{}{}\n", frame.tick(), rate_hz_,
                    frame.armed() ? "ARMED" : "disarmed", frame.paused() ? "  PAUSED" : "",
                    progress_.lost > 0 ? fmt::format("  {} lost", count_of(progress_.lost, "frame")) : "");
    for (const std::string& table :
         {objects_table(names_, frame.objects()), devices_table(names_, frame.devices()),
          fingers_table(names_, frame.hips()),
          options_.hips ? hips_table(names_, frame.hips()) : std::string()}) {
      text += table.empty() ? "" : "\n" + table;
    }
    for (const std::string& last : {progress_.last_stats, progress_.last_event}) {
      text += last.empty() ? "" : "\n" + last + "\n";
    }
    return text;
  }

  // one line for a frame: what a log needs
  std::string line(const v1::Frame& frame) const {
    std::string text = fmt::format("tick {}  {}", frame.tick(), frame.armed() ? "armed" : "disarmed");
    text += frame.paused() ? "  paused" : "";
    const auto& objects = frame.objects().position();
    for (int i = 0; 3 * i + 2 < objects.size(); ++i) {
      text += fmt::format("  {} {} {} {} mm", object_name(names_, frame.objects(), i),
                          millimetres(objects[3 * i]), millimetres(objects[3 * i + 1]),
                          millimetres(objects[3 * i + 2]));
    }
    if (frame.has_hips()) {
      for (const FingerSummary& finger : summarise_fingers(names_, frame.hips())) {
        const double force = std::hypot(finger.force[0], finger.force[1], finger.force[2]);
        text += fmt::format("  {} {:.3f} N, {} of {} HIPs touch, {} slip", finger.name, force,
                            finger.contacts, finger.hips, finger.slipping);
      }
    }
    return text;
  }

  bool json_;
  WatchOptions options_;
  client::Connection& daemon_;
  std::uint32_t subscription_ = 0;
  double rate_hz_ = 0.0;
  Names names_;
  Progress progress_;
  std::optional<Screen> screen_;
};

}  // namespace

void add_watch(CLI::App& app, Command& command) {
  const auto options = std::make_shared<WatchOptions>();
  options->topics = {v1::OBJECTS, v1::HIPS, v1::DEVICES};
  CLI::App& verb = add_verb(app, command, "watch", "what happens, live; Ctrl-C ends it",
                            [options](Command& chosen) { return Watch(chosen, *options).run(); });
  const Words<v1::Topic> topics = {{"objects", v1::OBJECTS},
                                   {"hips", v1::HIPS},
                                   {"devices", v1::DEVICES},
                                   {"events", v1::EVENTS},
                                   {"stats", v1::STATS}};
  add_choices(verb, "--topic", options->topics,
              "objects, hips, devices, events, stats; default: the first three. Events are shown in any "
              "case; as a topic they have sequence numbers",
              topics)
      .type("TOPIC")
      .separated_by(',');
  add_option(verb, "--finger", options->fingers, "only the HIPs of these; default: of all")
      .type("NAME")
      .separated_by(',');
  add_option(verb, "--object", options->objects, "only these, and contacts with them; default: all")
      .type("NAME")
      .separated_by(',');
  add_flag(verb, "--in-contact", options->only_in_contact, "only HIPs that are in contact");
  const Words<v1::Delivery> deliveries = {{"latest", v1::LATEST}, {"lossless", v1::LOSSLESS}};
  add_choice(verb, "--delivery", options->delivery,
             "latest: newer frames replace those that wait; lossless: all wait; default: latest on a "
             "terminal, else lossless",
             deliveries)
      .type("HOW");
  add_option(verb, "--rate", options->rate,
             "frames a second; default: 20 on a terminal, 1 in lines, every tick with --json")
      .positive()
      .type("HZ");
  add_option(verb, "--seconds", options->seconds, "end after so long").positive();
  add_option(verb, "--count", options->count, "end after so many frames").positive();
  add_flag(verb, "--hips", options->hips, "a table of each HIP in contact, too");
}

}  // namespace haptic::cli
