// A recording: framed envelopes whose responses hold scenes and states, and whose frames hold inputs.
// Whatever comes, it is replayed or refused; what is refused ends the replay.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "load/config_file.h"
#include "load/error.h"
#include "load/scene_file.h"
#include "load/state_message.h"
#include "proto/framing.h"
#include "proto/protocol.h"
#include "replay/replayer.h"
#include "tests/fuzz/schema_mutator.h"

namespace {

using namespace haptic;

class Session {
 public:
  void take(const v1::Envelope& envelope) {
    const v1::Response& response = envelope.response();
    if (response.has_scene()) {
      scene_ = load::build_scene(response.scene().scene(), load::default_capacity());
      replayer_.add_scene(response.scene());
    }
    if (response.has_state() && scene_) {
      // no state that was changed has its own hash any more, and none would get past it
      v1::WorldState state = response.state();
      state.set_state_hash(engine::hash(load::read_state(state, scene_->scene)));
      replayer_.take(state);
    }
    if (envelope.has_frame()) {
      v1::Frame frame = envelope.frame();
      frame.mutable_inputs()->clear_state_hash();  // go on after a difference
      replayer_.take(frame);
    }
  }

 private:
  std::shared_ptr<const load::LoadedScene> scene_;
  replay::Replayer replayer_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  Session session;
  proto::FrameReader reader(proto::kRequestLimit);
  reader.append(std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  try {
    while (const auto message = reader.next()) {
      v1::Envelope envelope;
      if (envelope.ParseFromArray(message->data(), static_cast<int>(message->size()))) {
        session.take(envelope);
      }
    }
  } catch (const proto::FramingError&) {
    return 0;
  } catch (const load::LoadError&) {
    return 0;
  }
  return 0;
}

// three times of four as the schema allows; bytes at random for the rest
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  haptic::fuzz::Random random(seed);
  const std::size_t mutated =
      random() % 4 == 0 ? 0 : haptic::fuzz::mutate_conversation(data, size, max_size, random);
  return mutated > 0 ? mutated : LLVMFuzzerMutate(data, size, max_size);
}
