#include "client/cli/inputs_recorder.h"

#include <chrono>
#include <thread>

#include "client/cli/command.h"
#include "client/lib/error.h"

namespace haptic::cli {
namespace {

// the scene may just be changing
constexpr int kTries = 10;
constexpr std::chrono::milliseconds kBetweenTries{20};

v1::SceneDescription fetch_scene(client::Connection& daemon, std::uint64_t revision) {
  return call(daemon,
              [revision](v1::Request& request) {
                request.mutable_get_scene()->set_embed_meshes(true);
                request.mutable_get_scene()->set_revision(revision);
              })
      .scene();
}

}  // namespace

void InputsRecorder::begin() {
  // scenes that have run are kept as long as this lasts
  v1::Subscribe wish;
  wish.add_topic(v1::INPUTS);
  wish.set_delivery(v1::LOSSLESS);
  subscription_ = daemon_.subscribe(wish);
  try {
    fetch_scene(daemon_, 0);
    ask_for_state();
  } catch (const client::Error&) {
    end();
    throw;
  }
}

void InputsRecorder::ask_for_state() {
  for (int i = 1;; ++i) {
    try {
      state_ = call(daemon_, [](v1::Request& request) { request.mutable_get_state(); }).state();
      return;
    } catch (const client::Busy&) {
      if (i == kTries) throw;
      std::this_thread::sleep_for(kBetweenTries);
    }
  }
}

bool InputsRecorder::take(const v1::Envelope& message) {
  if (message.has_gap() && message.gap().subscription() == subscription_) {
    writer_.write(message.gap(), time_);
    lost_ += message.gap().last_sequence() - message.gap().first_sequence() + 1;
    ask_for_state();
    return true;
  }
  if (!message.has_frame() || message.frame().subscription() != subscription_) return false;
  write(message.frame());
  return true;
}

void InputsRecorder::write(const v1::Frame& frame) {
  time_ = frame.realtime_ns();
  if (state_) {
    // what lies before a state is of no use without the one before that
    if (frame.tick() <= state_->tick()) return;
    write_scene(state_->scene_revision(), time_);
    writer_.write(*state_, time_);
    state_.reset();
  }
  for (const v1::InputsFrame::Command& command : frame.inputs().command()) {
    if (command.kind() == v1::InputsFrame::SCENE) write_scene(command.scene_revision(), time_);
  }
  writer_.write(frame);
}

void InputsRecorder::write_scene(std::uint64_t revision, std::uint64_t time_ns) {
  if (scenes_.contains(revision)) return;
  writer_.write(fetch_scene(daemon_, revision), time_ns);
  scenes_.insert(revision);
}

void InputsRecorder::end() {
  if (subscription_ != 0) daemon_.unsubscribe(subscription_);
  subscription_ = 0;
}

}  // namespace haptic::cli
