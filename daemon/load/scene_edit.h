#pragma once
// A running scene is edited in two steps, neither of which touches what runs: the edits make another message
// of the scene's, with what became of each part, and that is built like any other scene.
//
// Names refer to the scene as the edits before have left it. All edits or none: the first that is wrong is
// told by its place in the request, such as "edit[2].add_object.name".

#include <memory>
#include <string>
#include <vector>

#include "engine/scene.h"
#include "haptic/v1/control.pb.h"
#include "load/scene_file.h"

namespace haptic::load {

/// More edits than these in one request are refused.
inline constexpr int kMostEdits = 4096;

/// The scene after the edits. Each list goes with the one of the same name in `message`.
struct EditedScene {
  struct Part {
    engine::Index from = engine::kNone;  // the part before the edits; kNone: new, or an object put elsewhere
    std::string edit;                    // the field of the request that last set it; empty: none
    std::string pose;                    // the same for an object's pose, where that was set alone
  };

  v1::Scene message;
  std::vector<Part> objects;
  std::vector<Part> materials;
  std::vector<Part> fingers;
  std::string gravity;  // the field that set it
};

/// Does the edits, and checks what is theirs to check: names, field paths, materials in use, and that no file
/// is named. What the parts hold is checked by build_edited. Pure. Throws LoadError.
EditedScene edit_scene(const v1::Scene& scene, const v1::EditScene& request);

/// Builds the edited scene with the cells of `running`, which is what was built of the message before the
/// edits, wherever a shape is the same. An error is told by the field of the request that is to blame, if one
/// is, else by the field of the scene. Throws LoadError. Not real-time safe.
std::shared_ptr<const LoadedScene> build_edited(const EditedScene& edited, const Built& running,
                                                const v1::Capacity& capacity);

/// Where each part of `parts` comes from.
std::vector<engine::Index> origins(const std::vector<EditedScene::Part>& parts);

}  // namespace haptic::load
