#include "ipc/handlers.h"
#include "ipc/reports.h"
#include "load/state_message.h"
#include "servo/prepare_scene.h"

namespace haptic::ipc {

std::size_t state_bytes(const engine::Scene& scene) noexcept {
  constexpr std::size_t kContactBytes = 6 * sizeof(double) + 9;
  constexpr std::size_t kHipBytes = 6 * sizeof(double);
  constexpr std::size_t kObjectBytes = 19 * sizeof(double);
  return scene.objects.size() * (scene.hip_count * kContactBytes + kObjectBytes) +
         scene.hip_count * kHipBytes;
}

v1::WorldState report_state(const servo::Event& answer, const Services& services) {
  v1::WorldState state;
  state.set_tick(answer.tick);
  state.set_scene_revision(answer.copy->revision);
  state.set_rate_hz(services.rate_hz);
  for (const v1::DeviceDescription& device : services.devices) {
    state.add_device(device.name());
  }
  state.set_paused(answer.copy->paused);
  state.set_steps_left(answer.copy->steps_left);
  load::write_state(answer.copy->state, state);
  return state;
}

namespace {

// the daemon copies states for itself, too, and one at a time
constexpr int kTries = 3;

void copy_state(Desk& desk, const Reply& reply, int tries) {
  const auto on_copy = [&desk, reply, tries](Outcome outcome, const servo::Event* answer) {
    if (outcome == Outcome::kDone) {
      v1::Response response;
      *response.mutable_state() = report_state(*answer, desk.services);
      reply.send(std::move(response));
    } else if (outcome == Outcome::kOutdated && tries > 1) {
      copy_state(desk, reply, tries - 1);
    } else if (outcome == Outcome::kOutdated) {
      reply.fail(v1::Error::BUSY, "the scene has just changed, or another state is being copied; try again");
    } else {
      reply.fail(v1::Error::FAILED, "the servo thread does not answer");
    }
  };
  if (!desk.servo.submit(servo::copy_buffer(desk.scenes.running(), desk.scenes.current().revision()),
                         SteadyClock::now(), on_copy)) {
    reply.fail(v1::Error::BUSY, "the servo thread has too many commands waiting; try again");
  }
}

}  // namespace

void handle_get_state(Desk& desk, const Caller& caller, const v1::Request& /*request*/, const Reply& reply) {
  const std::size_t bytes = state_bytes(desk.scenes.running());
  if (bytes > caller.answer_bytes) {
    reply.fail(v1::Error::INVALID, "the state of the scene takes about " + std::to_string(bytes) +
                                       " bytes, and an answer may have " +
                                       std::to_string(caller.answer_bytes) +
                                       " (limits.pending_control of the config)");
    return;
  }
  copy_state(desk, reply, kTries);
}

}  // namespace haptic::ipc
