#include "engine/carry_map.h"

#include <algorithm>

namespace haptic::engine {
namespace {

bool is_same(const Pose& a, const Pose& b) noexcept {
  return a.position == b.position && a.orientation == b.orientation;
}

bool moves_alike(const Object& before, const Object& after) noexcept {
  const MassProperties& a = before.dynamics.mass;
  const MassProperties& b = after.dynamics.mass;
  if (before.dynamic != after.dynamic) return false;
  return !before.dynamic || (a.mass == b.mass && a.inertia == b.inertia &&
                             is_same(a.object_from_gravity_centre, b.object_from_gravity_centre));
}

bool holds_alike(const Object& before, const Object& after) {
  return before.cells == after.cells &&
         std::equal(before.materials.begin(), before.materials.end(), after.materials.begin(),
                    after.materials.end(),
                    [](const Material& a, const Material& b) { return is_rigid(a) == is_rigid(b); });
}

}  // namespace

CarryMap make_carry_map(const Scene& before, const Scene& after, std::span<const Index> object_from,
                        std::span<const Index> finger_from) {
  CarryMap map;
  for (std::size_t i = 0; i < after.objects.size(); ++i) {
    CarriedObject& carried = map.objects.emplace_back();
    carried.from = object_from[i];
    if (carried.from == kNone) continue;
    const Object& old = before.objects[carried.from];
    carried.motion = moves_alike(old, after.objects[i]);
    carried.contacts = holds_alike(old, after.objects[i]);
  }
  for (std::size_t f = 0; f < after.fingers.size(); ++f) {
    const Finger& finger = after.fingers[f];
    Index from = finger_from[f];
    if (from != kNone) {
      const Finger& old = before.fingers[from];
      if (old.device != finger.device || old.hips != finger.hips) from = kNone;
    }
    map.fingers.push_back(from);
  }
  return map;
}

}  // namespace haptic::engine
