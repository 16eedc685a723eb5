#pragma once
// The io thread's end of the command and event queues: commands go in, answers come back by request number.
// Frees scenes that the servo thread no longer uses. io thread.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>

#include "servo/mailbox.h"

namespace haptic::ipc {

using SteadyClock = std::chrono::steady_clock;

enum class Outcome { kDone, kNothingToDo, kFaultRefused, kForceWaits, kOutdated, kNoAnswer };

class ServoLink {
 public:
  using OnAnswer = std::function<void(Outcome)>;
  /// `answer` is nullptr if there was none.
  using OnAnswerEvent = std::function<void(Outcome, const servo::Event* answer)>;
  using OnEvent = std::function<void(const servo::Event&)>;

  /// `on_event` sees every event but kSceneRetired, answers too, and before the one who asked does.
  ServoLink(servo::Mailbox& mailbox, std::chrono::milliseconds patience, OnEvent on_event);

  /// Sends a command; its request number is chosen here. False if the queue is full, and then nothing was
  /// sent. Without an answer within the patience and what the command itself takes, `on_answer` gets
  /// kNoAnswer.
  bool submit(servo::Command command, SteadyClock::time_point now, OnAnswer on_answer,
              std::chrono::milliseconds takes = std::chrono::milliseconds(0));

  /// As submit(), for one who wants to know more of the answer than its outcome.
  bool ask(servo::Command command, SteadyClock::time_point now, OnAnswerEvent on_answer,
           std::chrono::milliseconds takes = std::chrono::milliseconds(0));

  /// Sends kCopyState with `copy` as its buffer, as submit() does. The answer's buffer is the one who asked's
  /// to read until `on_answer` returns.
  bool submit(std::unique_ptr<servo::StateCopy> copy, SteadyClock::time_point now, OnAnswerEvent on_answer);

  /// Takes what the servo thread has sent. To be called every few milliseconds.
  void poll(SteadyClock::time_point now);

 private:
  struct Pending {
    SteadyClock::time_point deadline;
    OnAnswerEvent on_answer;
  };

  bool send(servo::Command command, SteadyClock::time_point deadline, OnAnswerEvent on_answer);

  void take(const servo::Event& event);

  servo::Mailbox& mailbox_;
  std::chrono::milliseconds patience_;
  OnEvent on_event_;
  std::uint64_t last_request_ = 0;
  std::map<std::uint64_t, Pending> pending_;  // by request
};

}  // namespace haptic::ipc
