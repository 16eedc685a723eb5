#include "load/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "load/ranges.h"
#include "load/read_file.h"

namespace haptic::load {
namespace {

constexpr Range kDensities{0.0, 1e6, " kg/m^3"};
constexpr Range kFrictions{0.0, 1e3, ""};

// static friction is never the smaller one: a proxy that starts to slip would be stopped at once
void check_friction(const TextSource& source, const std::string& field, double static_friction,
                    double kinetic_friction) {
  check_range(source, field + ".static_friction", static_friction, kFrictions);
  check_range(source, field + ".kinetic_friction", kinetic_friction, kFrictions);
  if (static_friction < kinetic_friction) {
    source.fail(field + ".static_friction", to_text(static_friction) + " is less than kinetic_friction, " +
                                                to_text(kinetic_friction) + " (permitted: from there on)");
  }
}

int hip_count(const TextSource& source, const std::string& field, double hips, std::size_t most) {
  if (most == 0) source.fail(field, "is beyond the capacity for HIPs, which the fingers before it use up");
  check_range(source, field, hips, {1.0, static_cast<double>(most)});
  return static_cast<int>(hips);
}

std::vector<glm::dvec3> make_fingertip(const TextSource& source, const std::string& field,
                                       const v1::Finger::Fingertip& fingertip, std::size_t most_hips) {
  check_range(source, field + ".radius", fingertip.radius(), kSizes);
  check_range(source, field + ".cap_angle", fingertip.cap_angle(), {0.0, std::acos(-1.0), " rad"});
  const glm::dvec3 direction = make_point(source, field + ".direction", fingertip.direction());
  if (direction == glm::dvec3(0.0))
    source.fail(field + ".direction", "is zero (permitted: any other vector)");
  const int hips = hip_count(source, field + ".hips", fingertip.hips(), most_hips);
  return engine::fingertip_layout(fingertip.radius(), fingertip.cap_angle(), hips, direction);
}

}  // namespace

void Names::add(const std::string& name, int index) {
  const std::string field = item(list_, index) + ".name";
  if (name.empty()) source_.fail(field, "is missing: each " + list_ + " needs a name");
  const auto [same, is_new] = index_.emplace(name, index);
  if (!is_new) source_.fail(field, in_quotes(name) + " is also the name of " + item(list_, same->second));
}

int Names::find(const std::string& field, const std::string& name) const {
  constexpr std::size_t kMostTold = 20;
  const auto found = index_.find(name);
  if (found != index_.end()) return found->second;
  std::string known;
  std::size_t told = 0;
  for (const auto& [other, index] : index_) {
    if (told++ == kMostTold) {
      known += ", ...";
      break;
    }
    known += (known.empty() ? "" : ", ") + other;
  }
  source_.fail(
      field, "no " + list_ + " is named " + in_quotes(name) + "; known: " + (known.empty() ? "none" : known));
}

engine::Material make_material(const TextSource& source, const std::string& field,
                               const v1::Material& material) {
  engine::Material made;
  check_range(source, field + ".density", material.density(), kDensities);
  made.density = material.density();
  switch (material.motion_case()) {
    case v1::Material::kFree:
      return made;
    case v1::Material::kRigid:
      check_friction(source, field + ".rigid", material.rigid().static_friction(),
                     material.rigid().kinetic_friction());
      made.yield_force = engine::kRigid;
      made.static_friction = material.rigid().static_friction();
      made.kinetic_friction = material.rigid().kinetic_friction();
      return made;
    case v1::Material::kYielding:
      check_range(source, field + ".yielding.force", material.yielding().force(), {0.0, 1e6, " N", true});
      check_range(source, field + ".yielding.drag", material.yielding().drag(), {0.0, 1e6, " N s/m"});
      check_friction(source, field + ".yielding", material.yielding().static_friction(),
                     material.yielding().kinetic_friction());
      made.yield_force = material.yielding().force();
      made.drag = material.yielding().drag();
      made.static_friction = material.yielding().static_friction();
      made.kinetic_friction = material.yielding().kinetic_friction();
      return made;
    case v1::Material::kViscous:
      check_range(source, field + ".viscous.drag", material.viscous().drag(), {0.0, 1e6, " N s/m", true});
      made.drag = material.viscous().drag();
      return made;
    case v1::Material::MOTION_NOT_SET:
      break;
  }
  source.fail(field, "does not say how a proxy moves in it (permitted: free, rigid, yielding, viscous)");
}

glm::dvec3 make_point(const TextSource& source, const std::string& field, const v1::Vector3& point) {
  check_range(source, field + ".x", point.x(), kCoordinates);
  check_range(source, field + ".y", point.y(), kCoordinates);
  check_range(source, field + ".z", point.z(), kCoordinates);
  return {point.x(), point.y(), point.z()};
}

engine::Pose make_pose(const TextSource& source, const std::string& field, const v1::Pose& pose) {
  engine::Pose made;
  made.position = make_point(source, field + ".position", pose.position());
  const v1::Quaternion& q = pose.orientation();
  // scaled first, so that the length neither overflows nor vanishes
  const double largest = std::max({std::abs(q.w()), std::abs(q.x()), std::abs(q.y()), std::abs(q.z())});
  if (largest > 0.0) {
    made.orientation =
        glm::normalize(glm::dquat(q.w() / largest, q.x() / largest, q.y() / largest, q.z() / largest));
  }
  return made;
}

engine::Finger make_finger(const TextSource& source, const std::string& field, const v1::Finger& finger,
                           std::size_t most_hips) {
  engine::Finger made;
  made.name = finger.name();
  if (finger.device().empty()) source.fail(field + ".device", "is missing: each finger rides on a device");
  made.device = finger.device();
  check_range(source, field + ".stiffness", finger.stiffness(), {0.0, 1e6, " N/m", true});
  made.stiffness = finger.stiffness();
  switch (finger.layout_case()) {
    case v1::Finger::kPoint:
      hip_count(source, field + ".point", 1.0, most_hips);
      made.hips = engine::point_layout();
      return made;
    case v1::Finger::kLine: {
      const glm::dvec3 start = make_point(source, field + ".line.start", finger.line().start());
      const glm::dvec3 end = make_point(source, field + ".line.end", finger.line().end());
      made.hips = engine::line_layout(
          start, end, hip_count(source, field + ".line.hips", finger.line().hips(), most_hips));
      return made;
    }
    case v1::Finger::kFingertip:
      made.hips = make_fingertip(source, field + ".fingertip", finger.fingertip(), most_hips);
      return made;
    case v1::Finger::kPoints: {
      const int hips = hip_count(source, field + ".points.hip", finger.points().hip_size(), most_hips);
      for (int i = 0; i < hips; ++i) {
        made.hips.push_back(make_point(source, field + ".points." + item("hip", i), finger.points().hip(i)));
      }
      return made;
    }
    case v1::Finger::LAYOUT_NOT_SET:
      break;
  }
  source.fail(field, "does not say where its HIPs are (permitted: point, line, fingertip, points)");
}

}  // namespace haptic::load
