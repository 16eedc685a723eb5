#include "engine/scene.h"

namespace haptic::engine {

void number_hips(Scene& scene) {
  scene.hip_count = 0;
  for (Finger& finger : scene.fingers) {
    finger.first_hip = scene.hip_count;
    scene.hip_count += finger.hips.size();
  }
}

}  // namespace haptic::engine
