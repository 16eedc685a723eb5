#include "ipc/announcer.h"

#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

#include "ipc/convert.h"
#include "log/fields.h"
#include "proto/metrics/names.h"

namespace haptic::ipc {
namespace {

constexpr std::chrono::seconds kMissedPeriod{1};

struct Wording {
  v1::Event::Kind kind;
  const char* message;
};

// commands that nobody else need know of have none
std::optional<Wording> wording_of(servo::CommandKind command) noexcept {
  switch (command) {
    case servo::CommandKind::kArm:
      return Wording{v1::Event::ARMED, "armed: devices may push"};
    case servo::CommandKind::kDisarm:
      return Wording{v1::Event::DISARMED, "disarmed: no device pushes"};
    case servo::CommandKind::kPause:
      return Wording{v1::Event::PAUSED, "paused"};
    case servo::CommandKind::kResume:
      return Wording{v1::Event::RESUMED, "resumed"};
    case servo::CommandKind::kClearFault:
      return Wording{v1::Event::FAULT_CLEARED, "faults cleared"};
    case servo::CommandKind::kSwapScene:
      return Wording{v1::Event::SCENE_CHANGED, "another scene runs"};
    default:
      return std::nullopt;
  }
}

// for machines that read the journal
log::FieldList fields_of(const v1::Event& event) {
  log::FieldList fields = {{"HAPTICD_TICK", std::to_string(event.tick())}};
  if (event.has_fault()) fields.emplace_back("HAPTICD_FAULT", metrics::word_of(event.fault().kind()));
  const std::string& device = event.has_fault() ? event.fault().device() : event.device();
  if (!device.empty()) fields.emplace_back("HAPTICD_DEVICE", device);
  if (!event.recording().empty()) fields.emplace_back("HAPTICD_RECORDING", event.recording());
  return fields;
}

}  // namespace

Announcer::Announcer(const std::vector<v1::DeviceDescription>& devices, Broadcast broadcast)
    : devices_(devices), broadcast_(std::move(broadcast)) {}

void Announcer::announce(const servo::Event& event, const v1::SceneDescription& scene,
                         SteadyClock::time_point now) {
  v1::Event out;
  out.set_tick(event.tick);
  if (event.kind == servo::EventKind::kTicksMissed) {
    missed_ += event.count;
    missed_tick_ = event.tick;
    poll(now);
  } else if (event.kind == servo::EventKind::kFaultLatched) {
    out.set_kind(v1::Event::FAULT_LATCHED);
    *out.mutable_fault() = to_wire(event.fault, devices_);
    out.set_message("fault latched: " + in_words(out.fault()));
    tell(out);
  } else if (event.kind == servo::EventKind::kDone) {
    const std::optional<Wording> wording = wording_of(event.command);
    if (!wording) {
      return;
    }
    out.set_kind(wording->kind);
    out.set_message(wording->message);
    if (wording->kind == v1::Event::SCENE_CHANGED) {
      out.set_scene_revision(scene.revision());
      out.set_message("scene \"" + scene.scene().name() + "\" runs");
    }
    tell(out);
  }
}

void Announcer::announce(v1::Event event, std::uint64_t tick) {
  event.set_tick(tick);
  tell(event);
}

void Announcer::poll(SteadyClock::time_point now) {
  if (missed_ == 0 || now < next_missed_) {
    return;
  }
  v1::Event out;
  out.set_kind(v1::Event::TICKS_MISSED);
  out.set_tick(missed_tick_);
  out.set_message(std::to_string(missed_) + (missed_ == 1 ? " tick was" : " ticks were") + " missed");
  missed_ = 0;
  next_missed_ = now + kMissedPeriod;
  tell(out);
}

void Announcer::tell(const v1::Event& event) {
  const log::Fields fields(fields_of(event));
  const bool is_bad = event.kind() == v1::Event::FAULT_LATCHED || event.kind() == v1::Event::TICKS_MISSED;
  spdlog::log(is_bad ? spdlog::level::warn : spdlog::level::info, "tick {}: {}", event.tick(),
              event.message());
  broadcast_(event);
}

}  // namespace haptic::ipc
