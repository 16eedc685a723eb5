#include "load/scene_report.h"

#include <algorithm>
#include <set>

#include "load/describe_scene.h"
#include "load/ranges.h"
#include "load/read_file.h"

namespace haptic::load {
namespace {

using engine::CellComplex;
using engine::Index;
using engine::kNone;

ObjectReport report_object(const engine::Object& object) {
  const CellComplex& cells = *object.cells;
  ObjectReport report;
  report.name = object.name;
  report.dynamic = object.dynamic;
  report.release_after = object.release_after;
  report.cells = cells.cells().size();
  report.vertices = cells.vertices().size();
  report.edges = cells.edges().size();
  report.faces = cells.faces().size();
  report.surface_triangles = surface_faces(object).size();
  report.bytes = cells.bytes();
  for (Index edge = 0; edge < report.edges; ++edge) {
    report.most_cells_at_edge = std::max(report.most_cells_at_edge, cells.cells_of_edge(edge).size());
  }
  for (Index vertex = 0; vertex < report.vertices; ++vertex) {
    report.most_cells_at_vertex = std::max(report.most_cells_at_vertex, cells.cells_of_vertex(vertex).size());
  }
  report.mass = object.dynamics.mass.mass;
  report.inertia = object.dynamics.mass.inertia;
  return report;
}

class Warnings {
 public:
  Warnings(const LoadedScene& loaded, const LoadedConfig& config, std::vector<std::string>& warnings)
      : scene_(loaded.scene), config_(config), warnings_(warnings) {}

  void add() {
    std::set<std::string> used;
    for (std::size_t i = 0; i < scene_.fingers.size(); ++i) {
      const engine::Finger& finger = scene_.fingers[i];
      used.insert(finger.device);
      const int device = find_device(finger.device);
      if (device < 0) {
        warn(
            item("finger", static_cast<int>(i)) + ".device",
            "no device of the config is named " + in_quotes(finger.device) + "; the finger will stay absent");
      } else {
        check_start(i, start_of(device));
      }
    }
    for (int i = 0; i < config_.message.device_size(); ++i) {
      const std::string& name = config_.message.device(i).name();
      if (!used.contains(name)) warn(item("device", i), "no finger rides on " + in_quotes(name));
    }
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) check_stability(i);
  }

 private:
  void warn(const std::string& field, const std::string& message) {
    warnings_.push_back(field + ": " + message);
  }

  int find_device(const std::string& name) const {
    for (int i = 0; i < config_.message.device_size(); ++i) {
      if (config_.message.device(i).name() == name) return i;
    }
    return -1;
  }

  engine::Pose start_of(int device) const {
    const auto& path = config_.paths[static_cast<std::size_t>(device)];
    return path.empty() ? engine::Pose{} : engine::Pose{path.front().position, path.front().orientation};
  }

  // a HIP that starts inside rigid material feels nothing until it has left
  void check_start(std::size_t finger, const engine::Pose& world_from_device) {
    for (const engine::Object& object : scene_.objects) {
      const engine::Pose object_from_device = inverse(object.initial_pose) * world_from_device;
      const auto inside = std::count_if(
          scene_.fingers[finger].hips.begin(), scene_.fingers[finger].hips.end(),
          [&](const glm::dvec3& hip) { return is_inside_rigid(object, object_from_device * hip); });
      if (inside == 0) continue;
      warn(item("finger", static_cast<int>(finger)),
           std::to_string(inside) + " of its HIPs start inside rigid material of object " +
               in_quotes(object.name) + " and feel nothing until they have left it");
    }
  }

  static bool is_inside_rigid(const engine::Object& object, const glm::dvec3& point) {
    const CellComplex& cells = *object.cells;
    if (cells.locate(point) == kNone) return false;
    const auto permeable = [&](Index cell) {
      return !is_rigid(object.materials[cells.cells()[cell].region]);
    };
    return cells.locate_if(point, permeable) == kNone;
  }

  // velocity before position (symplectic Euler) is stable for a spring K on a mass m while K dt^2 < 4 m
  void check_stability(std::size_t index) {
    const engine::Object& object = scene_.objects[index];
    if (!object.dynamic) return;
    double stiffness = 0.0;
    for (const engine::Finger& finger : scene_.fingers) {
      stiffness += finger.stiffness * static_cast<double>(finger.hips.size());
    }
    const double rate = config_.message.servo().rate_hz();
    const double most = 4.0 * object.dynamics.mass.mass * rate * rate;
    if (stiffness < most) return;
    warn(item("object", static_cast<int>(index)), "is so light that it may shake: all HIPs together have " +
                                                      to_text(stiffness) + " N/m; at " + to_text(rate) +
                                                      " Hz its mass bears up to " + to_text(most) + " N/m");
  }

  const engine::Scene& scene_;
  const LoadedConfig& config_;
  std::vector<std::string>& warnings_;
};

}  // namespace

SceneReport report_scene(const LoadedScene& loaded, const LoadedConfig* config) {
  SceneReport report;
  report.name = loaded.scene.name;
  report.hips = loaded.scene.hip_count;
  report.warnings = loaded.warnings;
  for (const v1::Material& material : loaded.message.material()) report.materials.push_back(material.name());
  for (const engine::Object& object : loaded.scene.objects) report.objects.push_back(report_object(object));
  for (const engine::Finger& finger : loaded.scene.fingers) {
    report.fingers.push_back({finger.name, finger.device, finger.hips.size(), finger.stiffness});
  }
  if (config != nullptr) Warnings(loaded, *config, report.warnings).add();
  return report;
}

}  // namespace haptic::load
