#include <algorithm>
#include <cmath>

#include "engine/shapes.h"
#include "load/embedded_mesh.h"
#include "load/mesh_file.h"
#include "load/ranges.h"
#include "load/read_file.h"
#include "load/scene_file.h"
#include "load/scene_parts.h"

namespace haptic::load {
namespace {

constexpr int kMostOutline = 4096;

engine::TetraMesh make_extrusion(const TextSource& source, const std::string& field,
                                 const v1::Shape::Extrusion& extrusion, double air_margin) {
  std::vector<glm::dvec2> outline;
  check_range(source, field + ".outline", extrusion.outline_size(), {3, kMostOutline, " points"});
  for (int i = 0; i < extrusion.outline_size(); ++i) {
    const std::string corner = field + "." + item("outline", i);
    check_range(source, corner + ".x", extrusion.outline(i).x(), kCoordinates);
    check_range(source, corner + ".y", extrusion.outline(i).y(), kCoordinates);
    outline.emplace_back(extrusion.outline(i).x(), extrusion.outline(i).y());
  }
  check_range(source, field + ".height", extrusion.height(), kSizes);
  return engine::extrusion_mesh(outline, extrusion.height(), air_margin);
}

engine::TetraMesh make_mesh(const TextSource& source, const std::string& field, const v1::Shape& shape,
                            double air_margin) {
  switch (shape.kind_case()) {
    case v1::Shape::kBox: {
      const v1::Vector3& size = shape.box().size();
      check_range(source, field + ".box.size.x", size.x(), kSizes);
      check_range(source, field + ".box.size.y", size.y(), kSizes);
      check_range(source, field + ".box.size.z", size.z(), kSizes);
      return engine::box_mesh({size.x(), size.y(), size.z()}, air_margin);
    }
    case v1::Shape::kIcosphere:
      check_range(source, field + ".icosphere.radius", shape.icosphere().radius(), kSizes);
      check_range(source, field + ".icosphere.subdivisions", shape.icosphere().subdivisions(), {0, 6});
      return engine::icosphere_mesh(shape.icosphere().radius(),
                                    static_cast<int>(shape.icosphere().subdivisions()), air_margin);
    case v1::Shape::kCylinder:
      check_range(source, field + ".cylinder.radius", shape.cylinder().radius(), kSizes);
      check_range(source, field + ".cylinder.height", shape.cylinder().height(), kSizes);
      check_range(source, field + ".cylinder.segments", shape.cylinder().segments(), {3, 4096});
      return engine::cylinder_mesh(shape.cylinder().radius(), shape.cylinder().height(),
                                   static_cast<int>(shape.cylinder().segments()), air_margin);
    case v1::Shape::kExtrusion:
      return make_extrusion(source, field + ".extrusion", shape.extrusion(), air_margin);
    case v1::Shape::kMesh:
    case v1::Shape::KIND_NOT_SET:
      break;
  }
  source.fail(field, "has no kind (permitted: box, icosphere, cylinder, extrusion, mesh)");
}

/// The mesh as its file has it. An error within the file keeps the file's line; the field is told with it.
LoadedMesh read_mesh_of(const TextSource& source, const std::string& field,
                        const std::filesystem::path& path) {
  try {
    return read_mesh(path);
  } catch (const LoadError& error) {
    if (error.line() == 0) source.fail(field, error.what());
    throw LoadError({error.file(), error.line(), error.column(), field}, error.message());
  }
}

engine::CellComplex cells_of_message(const TextSource& source, const std::string& field,
                                     const v1::Shape::Tetrahedra& message) {
  const engine::TetraMesh mesh = mesh_of(source, field, message, kMostCells);
  try {
    return engine::CellComplex::build(mesh);
  } catch (const engine::MeshError& error) {
    source.fail(error.cell == engine::kNone ? field : field + "." + item("tag", static_cast<int>(error.cell)),
                error.what());
  }
}

engine::CellComplex cells_of_file(const TextSource& source, const std::string& field,
                                  const v1::Shape::Mesh& mesh, const std::filesystem::path* file,
                                  std::vector<std::string>& warnings) {
  if (file == nullptr) source.fail(field + ".path", "is refused: a scene that is sent cannot name files");
  if (mesh.path().empty()) source.fail(field + ".path", "is missing: expected the name of a mesh file");
  const double scale = mesh.scale() == 0.0 ? 1.0 : mesh.scale();
  check_range(source, field + ".scale", scale, {1e-9, 1e9, " m per unit"});

  LoadedMesh loaded = read_mesh_of(source, field + ".path", relative_to(*file, mesh.path()));
  if (loaded.skipped_cells != 0) {
    warnings.push_back(field + ": " + std::to_string(loaded.skipped_cells) +
                       " volume elements are no first-order tetrahedra and were left away");
  }
  if (loaded.mesh.cells.size() > kMostCells) {
    source.fail(field + ".path", "has " + std::to_string(loaded.mesh.cells.size()) +
                                     " cells (permitted: up to " + std::to_string(kMostCells) + ")");
  }
  for (glm::dvec3& vertex : loaded.mesh.vertices) {
    vertex *= scale;
    const double farthest = std::max({std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});
    if (farthest > kLargestLength) {
      source.fail(field,
                  "reaches " + to_text(farthest) + " m from its origin (" + to_text(kCoordinates) + ")");
    }
  }
  try {
    return engine::CellComplex::build(loaded.mesh);
  } catch (const engine::MeshError& error) {
    try {
      if (error.cell < loaded.places.size()) fail_at_cell(loaded, error.cell, error.what());
    } catch (const LoadError& placed) {
      if (placed.line() == 0) source.fail(field, placed.what());
      throw LoadError({placed.file(), placed.line(), 0, field}, placed.message());
    }
    source.fail(field, loaded.file + ": " + error.what());
  }
}

}  // namespace

engine::CellComplex make_cells(const TextSource& source, const std::string& field, const v1::Shape& shape,
                               double air_margin, const std::filesystem::path* file,
                               std::vector<std::string>& warnings) {
  if (shape.mesh().has_embedded()) {
    return cells_of_message(source, field + ".mesh.embedded", shape.mesh().embedded());
  }
  if (shape.has_mesh()) return cells_of_file(source, field + ".mesh", shape.mesh(), file, warnings);
  // what the ranges cannot tell - an outline that crosses itself, a margin too thin to be cut into cells -
  // the engine finds
  try {
    return engine::CellComplex::build(make_mesh(source, field, shape, air_margin));
  } catch (const std::invalid_argument& error) {
    source.fail(field, error.what());
  } catch (const engine::MeshError& error) {
    source.fail(field, std::string("cannot be cut into cells: ") + error.what());
  }
}

}  // namespace haptic::load
