// Scenes, as text format or JSON: what is accepted can be stepped, and steps to finite numbers.

#include <cmath>
#include <cstdlib>

#include "engine/world.h"
#include "load/config_file.h"
#include "load/scene_file.h"
#include "tests/fuzz/schema_mutator.h"
#include "tests/fuzz/text_input.h"

namespace {

// large shapes only cost time
bool is_large(const haptic::v1::Scene& scene) {
  for (const auto& object : scene.object()) {
    const auto& shape = object.shape();
    if (shape.icosphere().subdivisions() > 2 || shape.cylinder().segments() > 64 ||
        shape.extrusion().outline_size() > 64) {
      return true;
    }
  }
  return scene.object_size() > 8;
}

void step(const std::shared_ptr<const haptic::load::LoadedScene>& loaded) {
  using namespace haptic::engine;
  World world(std::shared_ptr<const Scene>(loaded, &loaded->scene));
  const std::vector<FingerPose> fingers(loaded->scene.fingers.size(), FingerPose{Pose{}, true});
  world.step(fingers, 1e-3);
  world.step(fingers, 1e-3);
  for (const BodyState& body : world.state().bodies) {
    if (!std::isfinite(body.world_from_object.position.x + body.velocity.x)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  static const v1::Capacity capacity = load::default_capacity();
  const std::string text = fuzz::text_of(data, size);
  try {
    v1::Scene message;
    const load::TextSource source = load::parse_message(text, "f", fuzz::syntax_of(text), message);
    if (is_large(message)) return 0;
    step(load::build_scene(std::move(message), source, nullptr, capacity));
  } catch (const load::LoadError&) {
    return 0;
  }
  return 0;
}

// three times of four as the schema allows; bytes at random for the rest, and for JSON
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  haptic::fuzz::Random random(seed);
  haptic::v1::Scene scratch;
  const std::size_t mutated =
      random() % 4 == 0 ? 0 : haptic::fuzz::mutate_text(scratch, data, size, max_size, random);
  return mutated > 0 ? mutated : LLVMFuzzerMutate(data, size, max_size);
}
