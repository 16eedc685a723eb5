#include "ipc/flight_recorder.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flight/fault_files.h"
#include "ipc/reports.h"
#include "proto/metrics/names.h"
#include "servo/prepare_scene.h"

namespace haptic::ipc {
namespace {

constexpr double kTail = 0.1;                           // s that are recorded after a fault
constexpr std::chrono::milliseconds kLongestTail{300};  // when ticks come late or not at all
constexpr std::chrono::milliseconds kStatePeriod{1000};
constexpr std::chrono::milliseconds kStateHaste{100};  // after a loss
constexpr std::chrono::milliseconds kStateRetry{50};   // when the servo thread was busy with another
// before the first tick that is wanted lies the state where a replay starts: it may be as old as the period,
// and it was on its way for a while
constexpr double kLead = 1.25;    // s
constexpr double kMargin = 0.75;  // s that are kept while a file is written, before there is no room
constexpr std::size_t kScenesKept = 64;

// what numbers of a frame take on the wire, about
constexpr std::size_t kFrameBytes = 96;
constexpr std::size_t kObjectBytes = 19 * sizeof(double);
constexpr std::size_t kHipBytes = 12 * sizeof(double) + 6;  // with a contact for each
constexpr std::size_t kDeviceBytes = 24 * sizeof(double);
constexpr std::size_t kInputBytes = 10 * sizeof(double) + 1;

std::size_t frame_bytes(TopicSet topics, std::size_t devices, const engine::Scene& scene) {
  std::size_t bytes = kFrameBytes + devices * (kDeviceBytes + kInputBytes);
  if ((topics & topic_bit(v1::OBJECTS)) != 0) bytes += scene.objects.size() * kObjectBytes;
  if ((topics & topic_bit(v1::HIPS)) != 0) bytes += scene.hip_count * kHipBytes;
  return bytes;
}

std::string in_words(const FlightPlan& plan) {
  std::string text;
  if ((plan.topics & topic_bit(v1::HIPS)) == 0) text = "HIPs";
  if ((plan.topics & topic_bit(v1::OBJECTS)) == 0) text += " and objects";
  return text;
}

std::uint64_t ticks_of(double seconds, double rate_hz) {
  return static_cast<std::uint64_t>(std::ceil(seconds * rate_hz));
}

}  // namespace

FlightPlan plan_flight(const FlightSettings& settings, double rate_hz, std::size_t devices,
                       const engine::Scene& scene) {
  FlightPlan plan;
  // a state that fills the memory leaves no room for ticks
  plan.keeps_states = state_bytes(scene) <= settings.bytes / 8;
  const double states = plan.keeps_states ? static_cast<double>(state_bytes(scene)) : 0.0;  // bytes/s
  const double around = kLead + kMargin;                                                    // s
  const TopicSet inputs = topic_bit(v1::INPUTS) | topic_bit(v1::DEVICES);
  const TopicSet objects = inputs | topic_bit(v1::OBJECTS);
  const auto room = static_cast<double>(settings.bytes);
  for (const TopicSet topics : {objects | topic_bit(v1::HIPS), objects, inputs}) {
    const double rate = rate_hz * static_cast<double>(frame_bytes(topics, devices, scene)) + states;
    plan.topics = topics;
    plan.seconds = std::clamp(room / rate - around, 0.0, settings.seconds);
    // more than that, since some HIPs are held by several objects
    plan.bytes =
        std::min(settings.bytes, static_cast<std::size_t>(1.25 * rate * (settings.seconds + around)) +
                                     2 * state_bytes(scene));
    if (rate * (settings.seconds + around) <= room) break;
  }
  return plan;
}

FlightRecorder::FlightRecorder(const FlightSettings& settings, const Services& services, Publisher& publisher,
                               ServoLink& servo, ReportDevices report_devices, OnWritten on_written)
    : settings_(settings),
      services_(services),
      publisher_(publisher),
      servo_(servo),
      report_devices_(std::move(report_devices)),
      on_written_(std::move(on_written)),
      tape_(settings.bytes) {
  spdlog::info("flight recorder: the last {} s before a fault are written to {}; {} MiB are reserved",
               settings_.seconds, settings_.directory, settings_.bytes >> 20U);
  const std::string problem = flight::find_problem(settings_.directory);
  if (!problem.empty()) spdlog::warn("flight recorder: {}; no fault can be recorded there", problem);
}

FlightRecorder::~FlightRecorder() {
  if (!writing_.valid()) return;
  try {
    spdlog::info("what came before the last fault is in {}", writing_.get());
  } catch (const std::exception& error) {
    spdlog::warn("the last fault is not recorded: {}", error.what());
  }
}

void FlightRecorder::learn(const v1::SceneDescription& scene, std::shared_ptr<const engine::Scene> built,
                           std::uint64_t from_tick) {
  const FlightPlan plan = plan_flight(settings_, services_.rate_hz, services_.devices.size(), *built);
  if (plan.topics != plan_.topics && (plan.topics & topic_bit(v1::HIPS)) == 0) {
    spdlog::warn("flight recorder: the scene is large, and its {} are left out; a replay computes them",
                 in_words(plan));
  }
  if (plan.seconds < settings_.seconds) {
    spdlog::warn("flight recorder: of this scene {:.1f} s fit into its memory", plan.seconds);
  }
  if (!plan.keeps_states) {
    spdlog::warn("flight recorder: the state of the scene is too large; recordings cannot be replayed");
  }
  const bool is_other = plan.topics != plan_.topics;
  plan_ = plan;
  tape_.use(plan_.bytes);
  if (is_other) subscribe();
  running_ = built;
  scenes_.push_back({.from_tick = from_tick,
                     .told = std::make_shared<const v1::SceneDescription>(scene),
                     .built = std::move(built)});
  if (scenes_.size() > kScenesKept) scenes_.pop_front();
}

void FlightRecorder::subscribe() {
  publisher_.unsubscribe(kDaemonItself, subscription_);
  subscription_ = publisher_.subscribe(
      kDaemonItself, {.topics = plan_.topics | topic_bit(v1::EVENTS), .delivery = v1::LOSSLESS},
      [this](const OutgoingFrame& frame) { take(frame); });
  sequence_ = 0;
}

void FlightRecorder::take(const OutgoingFrame& frame) {
  const bool is_tick = frame.topics != topic_bit(v1::EVENTS);
  // after a loss a replay goes on at the next state
  if (frame.sequence != sequence_ + 1) hasten_state();
  sequence_ = frame.sequence;
  if (is_tick) tick_ = frame.tick;
  keep({.kind = is_tick ? flight::EntryKind::kTick : flight::EntryKind::kOther,
        .tick = frame.tick,
        .sequence = frame.sequence,
        .subscription = frame.subscription},
       *frame.body);
}

void FlightRecorder::keep(flight::Entry entry, std::string_view bytes) {
  if (!tape_.append(entry, bytes)) ++not_kept_;
}

void FlightRecorder::hasten_state() { next_state_ = std::min(next_state_, last_state_ + kStateHaste); }

void FlightRecorder::forget() {
  const std::uint64_t kept = ticks_of(settings_.seconds + kLead, services_.rate_hz);
  // what belongs to a fault that waits is as old as it
  const std::uint64_t newest = waiting_ ? std::min(tick_, waiting_->first.tick()) : tick_;
  tape_.forget_before(newest - std::min(newest, kept));
  if (tape_.entries().empty()) return;
  const std::uint64_t oldest = tape_.entries().front().tick;
  while (scenes_.size() > 1 && scenes_[1].from_tick <= oldest) scenes_.pop_front();
}

void FlightRecorder::ask_for_state(SteadyClock::time_point now) {
  if (asks_ || !plan_.keeps_states || now < next_state_ || !running_) return;
  next_state_ = now + kStateRetry;
  const auto on_copy = [this](Outcome outcome, const servo::Event* answer) {
    asks_ = false;
    if (outcome != Outcome::kDone || answer->copy == nullptr) return;
    last_state_ = SteadyClock::now();
    next_state_ = last_state_ + kStatePeriod;
    keep({.kind = flight::EntryKind::kState, .tick = answer->tick},
         report_state(*answer, services_).SerializeAsString());
  };
  asks_ = servo_.submit(servo::copy_buffer(*running_, scenes_.back().told->revision()), now, on_copy);
}

void FlightRecorder::begin(const v1::Fault& fault, std::uint64_t number, SteadyClock::time_point now) {
  if (writing_.valid()) {
    spdlog::warn("the fault in tick {} is not recorded: that of the one before is still being written",
                 fault.tick());
    return;
  }
  if (!waiting_) {
    waiting_ = std::make_unique<Waiting>();
    waiting_->first = fault;
    waiting_->until_tick = fault.tick() + ticks_of(kTail, services_.rate_hz);
    waiting_->deadline = now + kLongestTail;
    waiting_->realtime_ns = monotonic_ns() + static_cast<std::uint64_t>(realtime_offset_ns());
  }
  waiting_->faults.push_back(number);
}

void FlightRecorder::poll(SteadyClock::time_point now) {
  forget();
  ask_for_state(now);
  if (waiting_ && (tick_ >= waiting_->until_tick || now >= waiting_->deadline)) write();
  if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) collect();
}

void FlightRecorder::finish() {
  if (waiting_) write();
}

void FlightRecorder::write() {
  const std::unique_ptr<Waiting> waiting = std::move(waiting_);
  const std::uint64_t before = ticks_of(settings_.seconds, services_.rate_hz);
  const std::uint64_t tick = waiting->first.tick();
  recording::Session session{.program = "hapticd " + services_.version,
                             .daemon_version = services_.version,
                             .rate_hz = services_.rate_hz};
  flight::Excerpt excerpt{.session = std::move(session),
                          .first_tick = tick - std::min(tick, before),
                          .entries = {},
                          .scenes = {scenes_.begin(), scenes_.end()},
                          .devices = report_devices_()};
  written_faults_ = waiting->faults;
  not_kept_ = 0;
  try {
    excerpt.entries = tape_.hold();
    writing_ = std::async(std::launch::async,
                          [excerpt = std::move(excerpt), settings = settings_, time = waiting->realtime_ns,
                           fault = metrics::word_of(waiting->first.kind())] {
                            return flight::save(excerpt, settings.directory, settings.keep, fault, time);
                          });
  } catch (const std::exception& error) {
    tape_.release();
    spdlog::warn("the fault in tick {} is not recorded: {}", tick, error.what());
  }
}

void FlightRecorder::collect() {
  std::string path;
  try {
    path = writing_.get();
  } catch (const std::exception& error) {
    spdlog::warn("the fault is not recorded: {}", error.what());
  }
  tape_.release();
  if (not_kept_ > 0) {
    spdlog::warn("flight recorder: {} frames were not kept while the recording was written", not_kept_);
    hasten_state();
  }
  on_written_(written_faults_, path);
}

}  // namespace haptic::ipc
