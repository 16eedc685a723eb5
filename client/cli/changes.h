#pragma once
// What the arguments of a verb say of an object, a material or a finger: changes to a message, in the order
// in which the options are declared. A new one begins empty, one that is set begins as it is in the scene.

#include <functional>
#include <string>
#include <vector>

#include "client/cli/options.h"
#include "haptic/v1/scene.pb.h"

namespace haptic::cli {

template <typename Message>
struct Changes {
  std::vector<std::function<void(Message&)>> steps;
  std::vector<std::string> fields;  // of SetObject: what the steps touch

  void add(const std::string& field, std::function<void(Message&)> step) {
    steps.push_back(std::move(step));
    fields.push_back(field);
  }

  Message applied_to(Message message) const {
    for (const auto& step : steps) {
      step(message);
    }
    return message;
  }
};

enum class Editing { kAdd, kSet };

/// Each adds the name and the options of a verb; the changes must live as long as the verb. What they are
/// made of is judged by the daemon; that they can go together is judged when they are read.
void add_object_options(CLI::App& verb, Changes<v1::Object>& changes, Editing editing);
void add_material_options(CLI::App& verb, Changes<v1::Material>& changes, Editing editing);
void add_finger_options(CLI::App& verb, Changes<v1::Finger>& changes, Editing editing);

using PoseChange = std::function<void(v1::Pose&)>;
using PoseEditor = std::function<void(const PoseChange&)>;

/// --at and --turn, of an object's pose; `edit` gets each change when its option is read.
void add_pose_options(CLI::App& verb, const PoseEditor& edit);

}  // namespace haptic::cli
