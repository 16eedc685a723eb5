#include "servo/prepare_scene.h"

#include <algorithm>
#include <utility>

namespace haptic::servo {

std::unique_ptr<PreparedScene> prepare_scene(std::shared_ptr<const engine::Scene> scene,
                                             std::uint64_t revision, std::span<const std::string> devices) {
  std::vector<std::uint32_t> device_of_finger;
  for (const engine::Finger& finger : scene->fingers) {
    const auto found = std::find(devices.begin(), devices.end(), finger.device);
    device_of_finger.push_back(found == devices.end() ? safety::kNoDevice
                                                      : static_cast<std::uint32_t>(found - devices.begin()));
  }
  std::vector<engine::FingerPose> poses(scene->fingers.size());
  return std::unique_ptr<PreparedScene>(new PreparedScene{.revision = revision,
                                                          .world = engine::World(std::move(scene)),
                                                          .device_of_finger = std::move(device_of_finger),
                                                          .finger_poses = std::move(poses)});
}

std::unique_ptr<StateCopy> copy_buffer(const engine::Scene& scene, std::uint64_t revision) {
  return std::unique_ptr<StateCopy>(
      new StateCopy{.revision = revision, .state = engine::initial_state(scene)});
}

}  // namespace haptic::servo
