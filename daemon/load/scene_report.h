#pragma once
// What `hapticd check` tells of a scene: numbers about each object and finger, and what is hardly meant.

#include <cstdint>
#include <string>
#include <vector>

#include "load/config_file.h"
#include "load/scene_file.h"

namespace haptic::load {

struct ObjectReport {
  std::string name;
  bool dynamic = false;
  double release_after = 0.0;  // s
  std::size_t cells = 0;
  std::size_t vertices = 0;
  std::size_t edges = 0;
  std::size_t faces = 0;
  std::size_t surface_triangles =
      0;  // where the material changes; outside the cells there is nothing to feel
  std::size_t bytes = 0;
  std::size_t most_cells_at_edge = 0;
  std::size_t most_cells_at_vertex = 0;
  double mass = 0.0;                  // kg; 0 if fixed
  glm::dvec3 inertia{0.0, 0.0, 0.0};  // principal, kg m^2
};

struct FingerReport {
  std::string name;
  std::string device;
  std::size_t hips = 0;
  double stiffness = 0.0;  // N/m of each HIP
};

struct SceneReport {
  std::string name;
  std::vector<std::string> materials;
  std::vector<ObjectReport> objects;
  std::vector<FingerReport> fingers;
  std::size_t hips = 0;
  std::vector<std::string> warnings;
};

/// `config` may be nullptr: then nothing is said about devices.
SceneReport report_scene(const LoadedScene& loaded, const LoadedConfig* config);

}  // namespace haptic::load
