#pragma once
// The parts of a scene, each checked and built on its own; only scene_file.cpp puts them together. `field` is
// where a part stands in the message, such as "object[2].shape". Each throws LoadError.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/cell_complex.h"
#include "engine/finger.h"
#include "engine/material.h"
#include "engine/pose.h"
#include "haptic/v1/scene.pb.h"
#include "load/text_message.h"

namespace haptic::load {

/// Names that must be there and be unique in one list of the message.
class Names {
 public:
  Names(const TextSource& source, std::string list) : source_(source), list_(std::move(list)) {}

  /// Throws LoadError if the name of item `index` is empty or taken.
  void add(const std::string& name, int index);
  /// The item of that name; throws LoadError at `field` naming those that exist.
  int find(const std::string& field, const std::string& name) const;

 private:
  const TextSource& source_;
  std::string list_;
  std::map<std::string, int> index_;
};

engine::Material make_material(const TextSource& source, const std::string& field,
                               const v1::Material& material);

engine::Pose make_pose(const TextSource& source, const std::string& field, const v1::Pose& pose);

/// Throws unless each coordinate is within +-kLargestLength.
glm::dvec3 make_point(const TextSource& source, const std::string& field, const v1::Vector3& point);

/// The cells of a shape. `file` is what the path of a mesh is relative to, nullptr refuses it; what is hardly
/// meant is added to `warnings`.
engine::CellComplex make_cells(const TextSource& source, const std::string& field, const v1::Shape& shape,
                               double air_margin, const std::filesystem::path* file,
                               std::vector<std::string>& warnings);

/// A finger of at most `most_hips` HIPs.
engine::Finger make_finger(const TextSource& source, const std::string& field, const v1::Finger& finger,
                           std::size_t most_hips);

}  // namespace haptic::load
