#pragma once
// Edits of the scene that runs: one message each, and the answer in words.

#include <string>

#include "client/cli/changes.h"
#include "client/cli/command.h"

namespace haptic::cli {

v1::SceneEdit set_object_edit(const Changes<v1::Object>& changes);

/// What `changes` make of the scene's material or finger of that name. Throws client::NotFound.
v1::SceneEdit set_material_edit(const v1::Scene& scene, const Changes<v1::Material>& changes);
v1::SceneEdit set_finger_edit(const v1::Scene& scene, const Changes<v1::Finger>& changes);

/// Sends the edit and prints `what` has become of it. A `revision` that is not 0 is the only one that may be
/// edited. Throws client::Error.
ExitCode send_edit(Command& command, const v1::SceneEdit& edit, const std::string& what,
                   std::uint64_t revision = 0);

/// Where the object is now. Throws client::NotFound.
v1::Pose ask_pose(Command& command, const std::string& object);

/// The scene that runs.
v1::SceneDescription ask_scene(Command& command);

}  // namespace haptic::cli
