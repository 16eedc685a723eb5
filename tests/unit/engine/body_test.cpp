#include "engine/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/portable_math.h"

namespace haptic::engine {
namespace {

constexpr double kDt = 1e-3;
constexpr glm::dvec3 kNoGravity{0.0, 0.0, 0.0};

BodyDynamics free_body(double mass, const glm::dvec3& inertia) {
  BodyDynamics body;
  body.mass.mass = mass;
  body.mass.inertia = inertia;
  return body;
}

// no two moments, axes or frames alike
BodyDynamics awkward_body() {
  BodyDynamics body = free_body(0.3, {1e-4, 2e-4, 2.7e-4});
  body.mass.object_from_gravity_centre = {{0.01, -0.02, 0.03},
                                          glm::normalize(glm::dquat{0.5, 0.1, -0.7, 0.3})};
  return body;
}

double rotation_energy(const BodyDynamics& body, const BodyState& state) {
  return 0.5 * glm::dot(state.angular_momentum, angular_velocity(body, state));
}

glm::dquat principal_orientation(const BodyDynamics& body, const BodyState& state) {
  return state.world_from_object.orientation * body.mass.object_from_gravity_centre.orientation;
}

// angle between two orientations
double angle_between(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat turn = glm::conjugate(a) * b;
  return 2.0 * std::asin(std::min(1.0, std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z)));
}

// a spin about the intermediate axis, slightly off it, which tumbles; world frame
glm::dvec3 tumbling_momentum(const BodyDynamics& body, const BodyState& state) {
  return principal_orientation(body, state) * (body.mass.inertia * glm::dvec3{0.01, 6.0, 0.02});
}

TEST(Integrate, FallsAsTheDiscreteSchemeSays) {
  // v(n) = g n dt and x(n) = dt sum v = g dt^2 n (n + 1) / 2
  const BodyDynamics body = free_body(2.0, {1.0, 1.0, 1.0});
  const glm::dvec3 gravity{0.0, -9.81, 0.0};
  BodyState state;
  constexpr int kTicks = 1000;
  for (int i = 0; i < kTicks; ++i) integrate(body, gravity, kDt, state);
  EXPECT_NEAR(state.velocity.y, -9.81 * kTicks * kDt, 1e-12);
  EXPECT_NEAR(state.world_from_object.position.y, -9.81 * kDt * kDt * kTicks * (kTicks + 1) / 2, 1e-12);
  EXPECT_EQ(state.world_from_object.position.x, 0.0);
  EXPECT_EQ(state.world_from_object.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(Integrate, FollowsTheExactVelocityThroughViscosity) {
  // m v' = m g - b v from rest: v(t) = (m g / b) (1 - exp(-b t / m)), at every tick and for any dt
  BodyDynamics body = free_body(0.036, {1.0, 1.0, 1.0});
  body.linear_viscosity = 0.8;
  const glm::dvec3 gravity{0.0, -0.98, 0.0};
  for (const double dt : {1e-4, 1e-3, 0.05, 1.0}) {
    BodyState state;
    for (int i = 1; i <= 20; ++i) {
      integrate(body, gravity, dt, state);
      const double expected = -0.036 * 0.98 / 0.8 * -std::expm1(-0.8 * i * dt / 0.036);
      ASSERT_NEAR(state.velocity.y, expected, 1e-16) << dt;
    }
  }
}

TEST(Integrate, ReachesTerminalVelocityUnderAHeldForce) {
  BodyDynamics body = free_body(0.5, {1.0, 1.0, 1.0});
  body.linear_viscosity = 4.0;
  BodyState state;
  state.applied.force = {2.0, 0.0, 0.0};
  for (int i = 0; i < 10000; ++i) integrate(body, kNoGravity, kDt, state);
  // each tick forgets b dt / m = 0.8 % of the roundings before it, and adds one of 1e-16
  EXPECT_NEAR(state.velocity.x, 2.0 / 4.0, 1e-16 / 0.008);
  // past the start-up, which costs m v / b: x = v (t - m / b), up to the first-order dt v
  EXPECT_NEAR(state.world_from_object.position.x, 0.5 * (10.0 - 0.5 / 4.0), 0.5 * kDt);
}

TEST(Integrate, SpinsDownAboutAPrincipalAxisExactly) {
  // I w' = -c w: L(t) = L exp(-c t / I), and with a torque T it ends at w = T / c
  BodyDynamics body = free_body(1.0, {1e-5, 2e-5, 3e-5});
  body.angular_viscosity = 1e-4;
  BodyState state;
  state.angular_momentum = {0.0, 0.0, 3e-4};
  for (int i = 0; i < 500; ++i) integrate(body, kNoGravity, kDt, state);
  EXPECT_NEAR(state.angular_momentum.z, 3e-4 * std::exp(-1e-4 * 0.5 / 3e-5), 1e-17);
  state.applied.torque = {0.0, 0.0, 5e-4};
  for (int i = 0; i < 20000; ++i) integrate(body, kNoGravity, kDt, state);
  EXPECT_NEAR(angular_velocity(body, state).z, 5.0, 1e-12);
}

TEST(Integrate, TurnsByTheExactAngleAboutAPrincipalAxis) {
  const BodyDynamics body = free_body(1.0, {1e-5, 2e-5, 3e-5});
  for (int axis = 0; axis < 3; ++axis) {
    BodyState state;
    state.angular_momentum[axis] = 7.0 * body.mass.inertia[axis];
    constexpr int kTicks = 10000;
    for (int i = 0; i < kTicks; ++i) integrate(body, kNoGravity, kDt, state);
    glm::dvec3 turn{0.0};
    turn[axis] = 7.0 * kTicks * kDt;
    EXPECT_LT(angle_between(state.world_from_object.orientation, rotation_by(turn)), 1e-12) << axis;
  }
}

TEST(Integrate, KeepsAngularMomentumToTheBitAndEnergyWithoutDrift) {
  const BodyDynamics body = awkward_body();
  BodyState state;
  const glm::dvec3 momentum = tumbling_momentum(body, state);
  state.angular_momentum = momentum;
  const double energy = rotation_energy(body, state);
  double worst[2] = {0.0, 0.0};  // relative error in the first and the last of ten parts
  constexpr int kTicks = 60000;  // a minute
  bool tumbled = false;
  for (int i = 0; i < kTicks; ++i) {
    integrate(body, kNoGravity, kDt, state);
    ASSERT_EQ(state.angular_momentum, momentum);
    const double error = std::abs(rotation_energy(body, state) / energy - 1.0);
    if (i < kTicks / 10) worst[0] = std::max(worst[0], error);
    if (i >= kTicks - kTicks / 10) worst[1] = std::max(worst[1], error);
    const glm::dvec3 spin = glm::conjugate(principal_orientation(body, state)) * state.angular_momentum;
    tumbled = tumbled || spin.y < 0.0;
  }
  EXPECT_TRUE(tumbled);
  EXPECT_LT(worst[0], 2e-6);
  EXPECT_LT(worst[1], 1.05 * worst[0]);
  EXPECT_NEAR(glm::length(state.world_from_object.orientation), 1.0, 1e-15);
}

// the same motion by classical Runge-Kutta on Euler's equations in the body frame: another method altogether
struct Spin {
  glm::dquat orientation;  // world from principal
  glm::dvec3 velocity;     // rad/s, principal frame
};

Spin derivative(const glm::dvec3& inertia, const Spin& s) {
  const glm::dvec3& w = s.velocity;
  return {s.orientation * glm::dquat(0.0, 0.5 * w), glm::cross(inertia * w, w) / inertia};
}

Spin advanced(const Spin& s, const Spin& rate, double dt) {
  return {s.orientation + dt * rate.orientation, s.velocity + dt * rate.velocity};
}

void runge_kutta(const glm::dvec3& inertia, double dt, Spin& s) {
  const Spin k1 = derivative(inertia, s);
  const Spin k2 = derivative(inertia, advanced(s, k1, 0.5 * dt));
  const Spin k3 = derivative(inertia, advanced(s, k2, 0.5 * dt));
  const Spin k4 = derivative(inertia, advanced(s, k3, dt));
  s.orientation = s.orientation + (dt / 6.0) * (k1.orientation + 2.0 * k2.orientation + 2.0 * k3.orientation +
                                                k4.orientation);
  s.velocity += (dt / 6.0) * (k1.velocity + 2.0 * k2.velocity + 2.0 * k3.velocity + k4.velocity);
}

TEST(Integrate, TumblesAsEulersEquationsSay) {
  const BodyDynamics body = awkward_body();
  BodyState state;
  state.angular_momentum = tumbling_momentum(body, state);
  Spin reference{principal_orientation(body, state), {0.01, 6.0, 0.02}};
  double worst = 0.0;
  for (int i = 0; i < 5000; ++i) {
    integrate(body, kNoGravity, kDt, state);
    runge_kutta(body.mass.inertia, kDt, reference);
    worst = std::max(worst, angle_between(principal_orientation(body, state), reference.orientation));
  }
  // second order: an error of about (w dt)^2 / 12 = 3e-6 of each radian turned, 30 of them
  EXPECT_LT(worst, 1e-4);
  // and with a hundredth of the step, ten thousand times closer
  BodyState fine;
  fine.angular_momentum = tumbling_momentum(body, fine);
  for (int i = 0; i < 500000; ++i) integrate(body, kNoGravity, kDt / 100, fine);
  EXPECT_LT(angle_between(principal_orientation(body, fine), reference.orientation), 1e-8);
}

TEST(Integrate, CarriesTheObjectRoundItsCentreOfGravity) {
  // without force the centre of gravity goes straight, however the body tumbles
  const BodyDynamics body = awkward_body();
  BodyState state;
  state.world_from_object = {{0.5, 0.6, 0.7}, glm::normalize(glm::dquat{0.1, 0.2, 0.3, 0.4})};
  state.velocity = {0.1, -0.2, 0.3};
  state.angular_momentum = tumbling_momentum(body, state);
  const glm::dvec3 start = centre_of_gravity(body, state);
  const Pose pose = state.world_from_object;
  for (int i = 0; i < 1000; ++i) integrate(body, kNoGravity, kDt, state);
  EXPECT_LT(glm::distance(centre_of_gravity(body, state), start + state.velocity), 1e-13);
  EXPECT_GT(angle_between(state.world_from_object.orientation, pose.orientation), 0.1);
}

TEST(Integrate, LeavesABodyAtRestToTheBit) {
  const BodyDynamics body = awkward_body();
  BodyState state;
  state.world_from_object = {{0.5, 0.6, 0.7}, glm::normalize(glm::dquat{0.1, 0.2, 0.3, 0.4})};
  const Pose pose = state.world_from_object;
  for (int i = 0; i < 1000; ++i) integrate(body, kNoGravity, kDt, state);
  EXPECT_EQ(state.world_from_object.position, pose.position);
  EXPECT_EQ(state.world_from_object.orientation, pose.orientation);
}

TEST(Integrate, TurnsAngularMomentumByTorqueInTheWorld) {
  const BodyDynamics body = awkward_body();
  BodyState state;
  state.applied.torque = {1e-4, -2e-4, 3e-4};
  for (int i = 0; i < 1000; ++i) integrate(body, kNoGravity, kDt, state);
  EXPECT_LT(glm::distance(state.angular_momentum, state.applied.torque), 1e-16);  // for 1 s
}

TEST(Integrate, DampsATumbleToRestWithoutGainingEnergy) {
  BodyDynamics body = awkward_body();
  body.angular_viscosity = 1e-4;
  BodyState state;
  state.angular_momentum = tumbling_momentum(body, state);
  double energy = rotation_energy(body, state);
  for (int i = 0; i < 20000; ++i) {
    integrate(body, kNoGravity, kDt, state);
    const double now = rotation_energy(body, state);
    ASSERT_LE(now, energy) << i;
    energy = now;
  }
  EXPECT_LT(energy, 1e-9);
}

bool all_finite(const BodyDynamics& body, const BodyState& state) {
  double sum = 0.0;
  for (const glm::dvec3& v : {state.velocity, state.angular_momentum, state.world_from_object.position,
                              angular_velocity(body, state)}) {
    for (int i = 0; i < 3; ++i) sum += std::isfinite(v[i]) ? 0.0 : 1.0;
  }
  const glm::dquat& q = state.world_from_object.orientation;
  return sum == 0.0 && std::isfinite(q.w + q.x + q.y + q.z);
}

TEST(Integrate, StaysFiniteWhateverFiniteInputItGets) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  for (const double size : {1e-300, 1e3, 1e10, 1e100, 1e200, 1e300, kLargest}) {
    for (const double viscosity : {0.0, 1e-300, 1.0, kLargest}) {
      for (const double mass : {1e-300, 1e-3, 1e300}) {
        BodyDynamics body = awkward_body();
        body.mass.mass = mass;
        body.mass.inertia *= mass;
        body.linear_viscosity = body.angular_viscosity = viscosity;
        BodyState state;
        state.applied = {{size, -size, size}, {size, size, -size}};
        state.velocity = {size, size, size};
        for (int i = 0; i < 20; ++i) {
          integrate(body, {0.0, -size, 0.0}, kDt, state);
          ASSERT_TRUE(all_finite(body, state)) << size << ' ' << viscosity << ' ' << mass;
          ASSERT_NEAR(glm::length(state.world_from_object.orientation), 1.0, 1e-14);
        }
      }
    }
  }
}

TEST(Integrate, StaysBoundedWhenItSpinsFasterThanATickCanTell) {
  const BodyDynamics body = awkward_body();
  for (const double speed : {1e3, 1e4, 1e6, 1e9}) {
    BodyState state;
    state.angular_momentum = speed * body.mass.inertia;
    const glm::dvec3 momentum = state.angular_momentum;
    for (int i = 0; i < 1000; ++i) integrate(body, kNoGravity, kDt, state);
    EXPECT_EQ(state.angular_momentum, momentum);
    EXPECT_NEAR(glm::length(state.world_from_object.orientation), 1.0, 1e-15);
  }
}

TEST(Integrate, TreatsABodyWithoutInertiaAsAPoint) {
  const BodyDynamics body = free_body(1.0, {0.0, 0.0, 0.0});
  BodyState state;
  state.applied = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  for (int i = 0; i < 1000; ++i) integrate(body, kNoGravity, kDt, state);
  EXPECT_NEAR(state.velocity.x, 1.0, 1e-12);
  EXPECT_EQ(state.world_from_object.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(angular_velocity(body, state), glm::dvec3(0.0));
}

}  // namespace
}  // namespace haptic::engine
