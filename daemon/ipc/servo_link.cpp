#include "ipc/servo_link.h"

#include <memory>
#include <utility>

namespace haptic::ipc {
namespace {

Outcome outcome_of(servo::EventKind kind) noexcept {
  switch (kind) {
    case servo::EventKind::kNothingToDo:
      return Outcome::kNothingToDo;
    case servo::EventKind::kFaultRefused:
      return Outcome::kFaultRefused;
    case servo::EventKind::kForceWaits:
      return Outcome::kForceWaits;
    case servo::EventKind::kOutdated:
      return Outcome::kOutdated;
    default:
      return Outcome::kDone;
  }
}

bool is_answer(servo::EventKind kind) noexcept {
  return kind == servo::EventKind::kDone || kind == servo::EventKind::kNothingToDo ||
         kind == servo::EventKind::kFaultRefused || kind == servo::EventKind::kForceWaits ||
         kind == servo::EventKind::kOutdated;
}

}  // namespace

ServoLink::ServoLink(servo::Mailbox& mailbox, std::chrono::milliseconds patience, OnEvent on_event)
    : mailbox_(mailbox), patience_(patience), on_event_(std::move(on_event)) {}

bool ServoLink::submit(servo::Command command, SteadyClock::time_point now, OnAnswer on_answer,
                       std::chrono::milliseconds takes) {
  return send(command, now + patience_ + takes,
              [on_answer = std::move(on_answer)](Outcome outcome, const servo::Event* /*answer*/) {
                on_answer(outcome);
              });
}

bool ServoLink::ask(servo::Command command, SteadyClock::time_point now, OnAnswerEvent on_answer,
                    std::chrono::milliseconds takes) {
  return send(command, now + patience_ + takes, std::move(on_answer));
}

bool ServoLink::submit(std::unique_ptr<servo::StateCopy> copy, SteadyClock::time_point now,
                       OnAnswerEvent on_answer) {
  servo::Command command;
  command.kind = servo::CommandKind::kCopyState;
  command.copy = copy.get();
  if (!send(command, now + patience_, std::move(on_answer))) {
    return false;
  }
  static_cast<void>(copy.release());  // the command holds it
  return true;
}

bool ServoLink::send(servo::Command command, SteadyClock::time_point deadline, OnAnswerEvent on_answer) {
  command.request = last_request_ + 1;
  // first what may fail: a command that the servo thread has can not be taken back
  const auto entry = pending_.emplace(command.request, Pending{deadline, std::move(on_answer)}).first;
  if (!mailbox_.commands.push(command)) {
    pending_.erase(entry);
    return false;
  }
  ++last_request_;
  return true;
}

void ServoLink::poll(SteadyClock::time_point now) {
  servo::Event event;
  while (mailbox_.events.pop(event)) {
    take(event);
  }
  for (auto entry = pending_.begin(); entry != pending_.end();) {
    if (entry->second.deadline > now) {
      ++entry;
      continue;
    }
    const OnAnswerEvent on_answer = std::move(entry->second.on_answer);
    entry = pending_.erase(entry);
    on_answer(Outcome::kNoAnswer, nullptr);
  }
}

void ServoLink::take(const servo::Event& event) {
  if (event.kind == servo::EventKind::kSceneRetired) {
    const std::unique_ptr<servo::PreparedScene> retired(event.scene);
    return;
  }
  const std::unique_ptr<servo::StateCopy> copy(event.copy);
  on_event_(event);
  if (!is_answer(event.kind)) {
    return;
  }
  const auto found = pending_.find(event.request);
  if (found != pending_.end()) {
    const OnAnswerEvent on_answer = std::move(found->second.on_answer);
    pending_.erase(found);
    on_answer(outcome_of(event.kind), &event);
  }
}

}  // namespace haptic::ipc
