#pragma once
// Scenes: haptic/v1/scene.proto into what the engine runs. Everything is checked here, so that no scene that
// is returned can make a tick fail: names, references, ranges, meshes, masses and capacities.
//
// A scene from a file may name mesh files. A scene that a client sends may not: the daemon reads no file for
// somebody else.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/scene.h"
#include "haptic/v1/config.pb.h"
#include "haptic/v1/scene.pb.h"
#include "load/text_message.h"

namespace haptic::load {

/// Cells of all objects of a scene together: about 3 GB of tables.
inline constexpr std::size_t kMostCells = 4'000'000;

struct LoadedScene {
  v1::Scene message;                  // as it was written
  engine::Scene scene;                // what was made of it; objects and fingers in the same order
  std::vector<std::string> warnings;  // what is allowed, but hardly meant
};

/// A scene and what was built of it, object by object.
struct Built {
  const v1::Scene& message;
  const engine::Scene& scene;
};

/// Reads and builds the scene of a file. Throws LoadError. Not real-time safe; takes seconds for large
/// meshes.
std::shared_ptr<const LoadedScene> load_scene(const std::filesystem::path& file,
                                              const v1::Capacity& capacity);

/// Builds a scene that a client sent. Mesh files in it are refused.
std::shared_ptr<const LoadedScene> build_scene(v1::Scene message, const v1::Capacity& capacity);

/// What both do: `file` is what mesh paths are relative to; nullptr refuses them. Shapes that `running` has
/// are not cut again, and its meshes not read again: the objects share its cells.
std::shared_ptr<const LoadedScene> build_scene(v1::Scene message, const TextSource& source,
                                               const std::filesystem::path* file,
                                               const v1::Capacity& capacity, const Built* running = nullptr);

}  // namespace haptic::load
