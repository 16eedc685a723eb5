#include "load/describe_scene.h"

namespace haptic::load {
namespace {

using engine::Index;
using engine::Material;

bool is_free(const Material& material) { return material.yield_force == 0.0 && material.drag == 0.0; }

bool same_motion(const Material& a, const Material& b) {
  return a.yield_force == b.yield_force && a.drag == b.drag && a.static_friction == b.static_friction &&
         a.kinetic_friction == b.kinetic_friction;
}

}  // namespace

v1::SceneDescription describe(const LoadedScene& loaded) {
  v1::SceneDescription description;
  *description.mutable_scene() = loaded.message;
  for (const engine::Object& object : loaded.scene.objects) {
    v1::SceneDescription::ObjectDescription& told = *description.add_object();
    told.set_name(object.name);
    told.set_cells(static_cast<std::uint32_t>(object.cells->cells().size()));
    told.set_vertices(static_cast<std::uint32_t>(object.cells->vertices().size()));
    told.set_bytes(object.cells->bytes());
    told.set_mass(object.dynamic ? object.dynamics.mass.mass : 0.0);
  }
  for (const engine::Finger& finger : loaded.scene.fingers) {
    v1::SceneDescription::FingerDescription& told = *description.add_finger();
    told.set_name(finger.name);
    told.set_device(finger.device);
    told.set_first_hip(static_cast<std::uint32_t>(finger.first_hip));
    told.set_hips(static_cast<std::uint32_t>(finger.hips.size()));
  }
  return description;
}

std::vector<Index> surface_faces(const engine::Object& object) {
  const auto cells = object.cells->cells();
  const auto material = [&](Index cell) -> const Material& { return object.materials[cells[cell].region]; };
  const auto faces = object.cells->faces();
  std::vector<Index> surface;
  for (Index i = 0; i < faces.size(); ++i) {
    const Material& own = material(faces[i].cells[0]);
    const Index other = faces[i].cells[1];
    if (other == engine::kNone ? !is_free(own) : !same_motion(own, material(other))) {
      surface.push_back(i);
    }
  }
  return surface;
}

}  // namespace haptic::load
