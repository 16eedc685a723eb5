// The paper's Fig. 5: two fingertips of eleven HIPs hold a wooden box near one end, in a tenth of gravity.
// Friction bears its weight and the twist of its overhang.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/shapes.h"
#include "engine/world.h"
#include "tests/support/expect_vector.h"
#include "tests/support/probe.h"

namespace haptic::engine {
namespace {

using glm::dvec3;
using test::near;

constexpr double kDt = 1e-3;
constexpr double kStiffness = 100.0;
constexpr double kGravity = 0.98;

/// The fingers close in on +-z of the box at `grip` (m) from its middle.
class Grasp {
 public:
  explicit Grasp(double grip) : grip_(grip), world_(scene()) {}

  /// 1 mm deep after 0.4 s; the box is let go at 0.6 s.
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const double t = static_cast<double>(world_.state().ticks) * kDt;
      const double z = 0.045 - 0.029 * std::min(1.0, t / 0.4);
      const std::array fingers{FingerPose{{{grip_, 0.05, -z}, {1.0, 0.0, 0.0, 0.0}}, true},
                               FingerPose{{{grip_, 0.05, z}, {1.0, 0.0, 0.0, 0.0}}, true}};
      world_.step(fingers, kDt);
    }
  }

  const World& world() const { return world_; }
  const State& state() const { return world_.state(); }
  const BodyState& box() const { return state().bodies[0]; }
  double weight() const { return kGravity * world_.scene().objects[0].dynamics.mass.mass; }
  double drop() const { return 0.05 - box().world_from_object.position.y; }
  double tilt() const {
    const glm::dquat& q = box().world_from_object.orientation;
    return 2.0 * std::asin(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z));
  }
  int contacts() const {
    int count = 0;
    for (const dvec3& force : state().hip_forces) count += force != dvec3{0.0} ? 1 : 0;
    return count;
  }

 private:
  static std::shared_ptr<const Scene> scene() {
    Object box;
    box.cells = std::make_shared<CellComplex>(CellComplex::build(box_mesh({0.08, 0.03, 0.03}, 0.02)));
    box.materials = {test::air(), test::rigid(1.0, 0.5)};
    box.materials[1].density = 500.0;
    box.initial_pose.position = {0.0, 0.05, 0.0};
    box.dynamic = true;
    box.dynamics = {mass_properties(*box.cells, box.materials), 0.8, 1e-4};
    box.release_after = 0.6;
    auto scene = std::make_shared<Scene>();
    scene->gravity = {0.0, -kGravity, 0.0};
    scene->objects = {box};
    scene->fingers = {{"thumb", "left", kStiffness, fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, 1.0}), 0},
                      {"index", "right", kStiffness, fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, -1.0}), 0}};
    number_hips(*scene);
    return scene;
  }

  double grip_;
  World world_;
};

struct Sag {
  double drop, tilt;  // m, rad clockwise seen from +z
};

/// Where 2 x 11 springs k hold the weight W if all stick and the tilt is small: a HIP at (x, y) from the
/// centre of gravity is stretched by (-tilt y, drop + tilt x), so that
///     sum k (drop + tilt x) = W  and  sum k (x (drop + tilt x) + y tilt y) = 0.
Sag expected_sag(double grip, double weight) {
  double n = 0.0;
  double sx = 0.0;
  double sr = 0.0;
  for (const dvec3& hip : fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, 1.0})) {
    const double x = grip + hip.x;
    n += 2.0;
    sx += 2.0 * x;
    sr += 2.0 * (x * x + hip.y * hip.y);
  }
  const double scale = weight / kStiffness / (n * sr - sx * sx);
  return {scale * sr, -scale * sx};
}

TEST(Grasp, HoldsABoxNearItsEndWithAllHips) {
  Grasp grasp(0.03);
  grasp.run(5000);
  EXPECT_EQ(grasp.contacts(), 22);
  EXPECT_TRUE(near(grasp.box().applied.force, {0.0, grasp.weight(), 0.0}, 1e-11));
  EXPECT_TRUE(near(grasp.box().applied.torque, {0.0, 0.0, 0.0}, 1e-12));
  EXPECT_LT(glm::length(grasp.box().velocity), 1e-12);
  // 2 mm and 3.7 degrees; the tilt makes an arm shorter by 0.2 % and lets the next one slide by as much
  const Sag sag = expected_sag(0.03, grasp.weight());
  EXPECT_NEAR(grasp.drop(), sag.drop, 0.01 * sag.drop);
  EXPECT_NEAR(grasp.tilt(), -sag.tilt, 0.01 * grasp.tilt());
}

TEST(Grasp, CentredGripSinksByTheWeightOnItsSprings) {
  Grasp grasp(0.0);
  grasp.run(5000);
  EXPECT_EQ(grasp.contacts(), 22);
  const Sag sag = expected_sag(0.0, grasp.weight());
  EXPECT_NEAR(grasp.drop(), sag.drop, 1e-5 * sag.drop);
  // the fingertips are not quite centred themselves: by 44 um
  EXPECT_NEAR(sag.drop, grasp.weight() / (22.0 * kStiffness), 1e-3 * sag.drop);
  EXPECT_LT(grasp.tilt(), 2e-4);
}

TEST(Grasp, FingersFeelTheWeightTogether) {
  Grasp grasp(0.03);
  grasp.run(5000);
  const auto& wrenches = grasp.state().finger_wrenches;
  // each bears half of the weight, and pushes back along its own direction
  EXPECT_NEAR(wrenches[0].force.y, -0.5 * grasp.weight(), 1e-6);
  EXPECT_NEAR(wrenches[1].force.y, -0.5 * grasp.weight(), 1e-6);
  EXPECT_LT(wrenches[0].force.z, -0.4);
  EXPECT_NEAR(wrenches[0].force.z, -wrenches[1].force.z, 1e-11);
  // both resist the twist of the overhang: together W times the arm to the grip
  const double arm = 0.03 - grasp.box().world_from_object.position.x;
  EXPECT_NEAR(wrenches[0].torque.z + wrenches[1].torque.z, grasp.weight() * arm, 1e-11);
}

}  // namespace
}  // namespace haptic::engine
