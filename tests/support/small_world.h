#pragma once
// Small worlds of cubes and fingers for tests of the whole step.

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "engine/portable_math.h"
#include "engine/shapes.h"
#include "engine/world.h"
#include "tests/support/probe.h"

namespace haptic::test {

inline constexpr double kDt = 1e-3;
inline constexpr double kStiffness = 100.0;  // N/m

/// A cube of 40 mm in 20 mm of air around the world's origin, 64 g if it is of test::rigid. `shift` is where
/// it stands in its own frame.
inline engine::Object cube(const engine::Material& solid, bool dynamic, const engine::Pose& shift = {}) {
  engine::TetraMesh mesh = engine::box_mesh({0.04, 0.04, 0.04}, 0.02);
  for (glm::dvec3& vertex : mesh.vertices) vertex = shift * vertex;
  engine::Object object;
  object.name = "cube";
  object.cells = std::make_shared<engine::CellComplex>(engine::CellComplex::build(mesh));
  object.materials = {air(), solid};
  object.initial_pose = engine::inverse(shift);
  object.dynamic = dynamic;
  if (dynamic) object.dynamics.mass = engine::mass_properties(*object.cells, object.materials);
  return object;
}

inline engine::Finger finger_of(const std::vector<glm::dvec3>& hips) {
  return {"finger", "device", kStiffness, hips, 0};
}

/// A scene of these and nothing else.
inline engine::World world_of(std::vector<engine::Object> objects, std::vector<engine::Finger> fingers,
                              const glm::dvec3& gravity = glm::dvec3{0.0}) {
  auto scene = std::make_shared<engine::Scene>();
  scene->gravity = gravity;
  scene->objects = std::move(objects);
  scene->fingers = std::move(fingers);
  engine::number_hips(*scene);
  return engine::World(scene);
}

inline engine::FingerPose at(const glm::dvec3& position, const glm::dvec3& turn = glm::dvec3{0.0}) {
  return {{position, engine::rotation_by(turn)}, true};
}

/// One tick of a world of one finger.
inline void step(engine::World& world, const engine::FingerPose& finger) { world.step({&finger, 1}, kDt); }

/// A stroke that pokes the cube on several sides, slides over edges and lets go at times. The same to the bit
/// on every machine.
inline engine::FingerPose stroke(int tick) {
  const double t = tick * kDt;
  const double reach = 0.024 + 0.007 * engine::sin_cos(7.0 * t).sine;
  const engine::SinCos round = engine::sin_cos(2.0 * t);
  return at({reach * round.cosine, reach * round.sine, 0.006 * engine::sin_cos(3.0 * t).sine},
            {0.3 * engine::sin_cos(t).sine, 0.2, t});
}

/// A fingertip and a point, two loose cubes, a little gravity: all of a State is used.
inline engine::World two_fingers_two_objects() {
  engine::Object other = cube(rigid(1.0, 0.5), true);
  other.initial_pose = {{0.03, 0.03, 0.0}, engine::rotation_by({0.3, 0.2, 0.1})};
  other.dynamics.angular_viscosity = 1e-5;
  other.dynamics.linear_viscosity = 0.1;
  return world_of(
      {cube(rigid(0.8, 0.5), true), other},
      {finger_of(engine::fingertip_layout(0.006, 1.0, 7, {1, 0, 0})), finger_of(engine::point_layout())},
      {0.0, -0.1, 0.0});
}

/// Ticks `from` to `to` of the stroke, of that world.
inline void run(engine::World& world, int from, int to) {
  for (int i = from; i < to; ++i) {
    const std::array fingers{stroke(i), stroke(3 * i + 1000)};
    world.step(fingers, kDt);
  }
}

}  // namespace haptic::test
