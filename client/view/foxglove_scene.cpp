#include "client/view/foxglove_scene.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

namespace haptic::gateway {
namespace {

using Face = std::array<std::uint32_t, 3>;

// of a positive cell (v0, v1, v2, v3), each seen from outside
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

std::set<std::string> free_materials(const v1::Scene& scene) {
  std::set<std::string> names;
  for (const v1::Material& material : scene.material()) {
    if (material.has_free()) {
      names.insert(material.name());
    }
  }
  return names;
}

view::Surface surface_of(const v1::Object& object, const std::set<std::string>& free) {
  const v1::Shape::Tetrahedra& mesh = object.shape().mesh().embedded();
  const auto vertices = static_cast<std::uint32_t>(mesh.vertex_size() / 3);
  std::set<std::int32_t> free_tags;
  for (const v1::Object::Region& region : object.region()) {
    if (free.contains(region.material())) {
      free_tags.insert(region.tag());
    }
  }
  // a face that two cells share is seen twice
  std::vector<std::pair<Face, Face>> faces;  // sorted, and as seen
  faces.reserve(static_cast<std::size_t>(mesh.cell_size()));
  for (int cell = 0; cell < mesh.cell_size() / 4; ++cell) {
    if (cell < mesh.tag_size() && free_tags.contains(mesh.tag(cell))) {
      continue;
    }
    const std::uint32_t* const corner = mesh.cell().data() + std::ptrdiff_t{4} * cell;
    if (std::any_of(corner, corner + 4, [&](std::uint32_t index) { return index >= vertices; })) {
      return {};
    }
    for (const auto& [a, b, c] : kFaces) {
      const Face face = {corner[a], corner[b], corner[c]};
      faces.emplace_back(sorted(face), face);
    }
  }
  std::sort(faces.begin(), faces.end());
  view::Surface surface;
  std::map<std::uint32_t, std::uint32_t> number;  // of the vertices that are on it
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool shared = (i > 0 && faces[i - 1].first == faces[i].first) ||
                        (i + 1 < faces.size() && faces[i + 1].first == faces[i].first);
    if (shared) {
      continue;
    }
    for (const std::uint32_t vertex : faces[i].second) {
      const auto [entry, is_new] = number.try_emplace(vertex, static_cast<std::uint32_t>(number.size()));
      if (is_new) {
        const double* const at = mesh.vertex().data() + std::ptrdiff_t{3} * vertex;
        surface.points.insert(surface.points.end(), at, at + 3);
      }
      surface.indices.push_back(entry->second);
    }
  }
  return surface;
}

}  // namespace

std::vector<view::Surface> surfaces_of(const v1::SceneDescription& scene) {
  const std::set<std::string> free = free_materials(scene.scene());
  std::vector<view::Surface> surfaces;
  surfaces.reserve(static_cast<std::size_t>(scene.scene().object_size()));
  for (const v1::Object& object : scene.scene().object()) {
    surfaces.push_back(object.shape().mesh().has_embedded() ? surface_of(object, free) : view::Surface());
  }
  return surfaces;
}

}  // namespace haptic::gateway
