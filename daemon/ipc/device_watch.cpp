#include "ipc/device_watch.h"

#include <string>
#include <utility>

#include "ipc/convert.h"

namespace haptic::ipc {
namespace {

constexpr std::chrono::milliseconds kLookPeriod{50};

std::string words_of(drivers::DevicePhase phase) {
  switch (phase) {
    case drivers::DevicePhase::kAbsent:
      return "absent";
    case drivers::DevicePhase::kFound:
      return "found, but not open";
    case drivers::DevicePhase::kOpening:
      return "opening";
    case drivers::DevicePhase::kHoming:
      return "homing";
    case drivers::DevicePhase::kReady:
      break;
  }
  return "ready";
}

}  // namespace

DeviceWatch::DeviceWatch(const Services& services, Tell tell)
    : services_(services), tell_(std::move(tell)), seen_(services.keepers.size()) {}

void DeviceWatch::poll(SteadyClock::time_point now) {
  if (now < next_look_) {
    return;
  }
  next_look_ = now + kLookPeriod;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const DeviceKeeper& keeper = services_.keepers[i];
    const drivers::DeviceState state = keeper.state();
    Seen& seen = seen_[i];
    const bool is_lost = state.losses != seen.state.losses;
    if ((state.phase == seen.state.phase && !is_lost) || now < seen.next) {
      continue;
    }
    seen = {state, now + kChangePeriod};
    v1::Event event;
    event.set_kind(v1::Event::DEVICE_CHANGED);
    event.set_device(services_.devices[i].name());
    event.set_phase(to_wire(state.phase));
    const std::string reason = keeper.words().reason;
    const std::string lost =
        is_lost && state.phase == drivers::DevicePhase::kReady ? "was lost, and is " : "";
    event.set_message("device " + event.device() + ": " + lost + words_of(state.phase) +
                      (reason.empty() ? "" : "; " + reason));
    tell_(event);
  }
}

}  // namespace haptic::ipc
