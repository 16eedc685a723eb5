#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

#include "ipc/convert.h"
#include "ipc/handlers.h"

namespace haptic::ipc {
namespace {

servo::Command command_of(const v1::Request& request) noexcept {
  servo::Command command;
  switch (request.call_case()) {
    case v1::Request::kArm:
      command.kind = servo::CommandKind::kArm;
      break;
    case v1::Request::kPause:
      command.kind = servo::CommandKind::kPause;
      break;
    case v1::Request::kResume:
      command.kind = servo::CommandKind::kResume;
      break;
    case v1::Request::kStep:
      command.kind = servo::CommandKind::kStep;
      command.ticks = std::max<std::uint64_t>(1, request.step().ticks());
      break;
    case v1::Request::kResetScene:
      command.kind = servo::CommandKind::kReset;
      break;
    case v1::Request::kClearFault:
      command.kind = servo::CommandKind::kClearFault;
      break;
    default:
      command.kind = servo::CommandKind::kDisarm;
      break;
  }
  return command;
}

// a step is answered when its ticks have run; nobody waits for more than an hour of them
std::chrono::milliseconds time_of(const servo::Command& command, double rate_hz) noexcept {
  constexpr double kHour = 3600e3;
  const double time_ms = 1e3 * static_cast<double>(command.ticks) / rate_hz;
  return std::chrono::milliseconds(static_cast<std::int64_t>(std::min(time_ms, kHour)));
}

std::string nothing_to_do(v1::Request::CallCase call) {
  switch (call) {
    case v1::Request::kArm:
      return "it is armed already";
    case v1::Request::kDisarm:
      return "it is disarmed already";
    case v1::Request::kPause:
      return "it is paused already";
    case v1::Request::kResume:
      return "it is not paused";
    case v1::Request::kStep:
      return "it is not paused; pause it to run single ticks";
    case v1::Request::kClearFault:
      return "no fault is latched";
    default:
      return "there is nothing to do";
  }
}

std::string name_fault(const Desk& desk) {
  for (const servo::DeviceSnapshot& device : desk.publisher.latest().devices) {
    if (device.fault.kind != safety::FaultKind::kNone) {
      return " (" + in_words(to_wire(device.fault, desk.services.devices)) + ")";
    }
  }
  return "";
}

std::string in_words(const servo::WaitingForce& waiting, const std::vector<v1::DeviceDescription>& devices) {
  std::array<char, 160> numbers{};
  std::snprintf(numbers.data(), numbers.size(),
                "%.3g N wait to push on it, where at most %.3g N may when it is armed (safety.max_arm_force)",
                waiting.force, waiting.limit);
  const std::string device = waiting.device < devices.size() ? devices[waiting.device].name() : "a device";
  return device + ": " + numbers.data() + "; take it out of what it touches, then arm again";
}

}  // namespace

void handle_servo_command(Desk& desk, const Caller& /*caller*/, const v1::Request& request,
                          const Reply& reply) {
  const v1::Request::CallCase call = request.call_case();
  const servo::Command command = command_of(request);
  const auto on_answer = [&desk, call, reply](Outcome outcome, const servo::Event* answer) {
    switch (outcome) {
      case Outcome::kDone:
        reply.done();
        break;
      case Outcome::kNothingToDo:
        reply.fail(v1::Error::NOTHING_TO_DO, nothing_to_do(call));
        break;
      case Outcome::kFaultRefused:
        reply.fail(v1::Error::FAULT_LATCHED,
                   "a fault is latched" + name_fault(desk) + "; find its cause, then clear it");
        break;
      case Outcome::kForceWaits:
        reply.fail(v1::Error::FAILED, "not armed: " + in_words(answer->waiting, desk.services.devices));
        break;
      case Outcome::kOutdated:  // of edits only
      case Outcome::kNoAnswer:
        reply.fail(v1::Error::FAILED, "the servo thread does not answer");
        break;
    }
  };
  const bool sent =
      desk.servo.ask(command, SteadyClock::now(), on_answer, time_of(command, desk.services.rate_hz));
  if (!sent) {
    reply.fail(v1::Error::BUSY, "the servo thread has too many commands waiting; try again");
  }
}

void handle_emergency_stop(Desk& desk, const Caller& /*caller*/, const v1::Request& /*request*/,
                           const Reply& reply) {
  // not in the queue of commands, where others may be before it
  desk.services.mailbox.emergency_stop.store(true, std::memory_order_release);
  servo::Command command;
  command.kind = servo::CommandKind::kEmergencyStop;
  const bool sent = desk.servo.submit(command, SteadyClock::now(), [reply](Outcome outcome) {
    if (outcome == Outcome::kNoAnswer) {
      reply.fail(v1::Error::FAILED, "the servo thread does not answer; forces expire by themselves");
    } else {
      reply.done();
    }
  });
  // the next tick sees it, whether or not there was room to ask for an answer
  if (!sent) {
    reply.done();
  }
}

void handle_arm(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  if (const auto refusal = desk.lease.refusal(caller.id)) {
    reply.fail(v1::Error::REFUSED, *refusal + "; only its holder can arm");
    return;
  }
  handle_servo_command(desk, caller, request, reply);
}

}  // namespace haptic::ipc
