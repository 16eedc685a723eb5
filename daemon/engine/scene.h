#pragma once
// What there is to feel: immutable, built off the servo thread, shared. All that a tick changes is in
// state.h.

#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/body.h"
#include "engine/cell_complex.h"
#include "engine/finger.h"
#include "engine/material.h"

namespace haptic::engine {

/// A body with a cell complex.
struct Object {
  std::string name;
  std::shared_ptr<const CellComplex> cells;
  std::vector<Material> materials;  // by Cell::region
  Pose initial_pose;                // world_from_object at the start
  bool dynamic = false;             // false, or without mass: fixed in the world
  BodyDynamics dynamics;            // used if dynamic
  double release_after = 0.0;       // s from tick 0 during which a dynamic object is still held where it is
};

struct Scene {
  std::string name;
  glm::dvec3 gravity{0.0, 0.0, 0.0};  // m/s^2, world
  std::vector<Object> objects;
  std::vector<Finger> fingers;  // in the order of their HIPs: first_hip ascends without gaps
  std::size_t hip_count = 0;
};

/// Numbers the HIPs: sets first_hip of each finger and hip_count.
void number_hips(Scene& scene);

}  // namespace haptic::engine
