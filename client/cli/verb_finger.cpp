#include <memory>

#include "client/cli/edit.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

void add_finger_add(CLI::App& finger, Command& command) {
  const auto changes = std::make_shared<Changes<v1::Finger>>();
  CLI::App& verb = add_verb(finger, command, "add", "a finger more", [changes](Command& chosen) {
    v1::SceneEdit edit;
    *edit.mutable_add_finger() = changes->applied_to({});
    return send_edit(chosen, edit, "added finger " + edit.add_finger().name());
  });
  add_finger_options(verb, *changes, Editing::kAdd);
}

// the message replaces all of it, so that what is not told is taken from the scene, which must not change
// meanwhile
void add_finger_set(CLI::App& finger, Command& command) {
  const auto changes = std::make_shared<Changes<v1::Finger>>();
  CLI::App& verb = add_verb(finger, command, "set", "change what it is", [changes](Command& chosen) {
    const v1::SceneDescription scene = ask_scene(chosen);
    const v1::SceneEdit edit = set_finger_edit(scene.scene(), *changes);
    return send_edit(chosen, edit, "changed finger " + edit.set_finger().name(), scene.revision());
  });
  add_finger_options(verb, *changes, Editing::kSet);
}

void add_finger_remove(CLI::App& finger, Command& command) {
  const auto name = std::make_shared<std::string>();
  CLI::App& verb = add_verb(finger, command, "remove", "a finger less", [name](Command& chosen) {
    v1::SceneEdit edit;
    edit.set_remove_finger(*name);
    return send_edit(chosen, edit, "removed finger " + *name);
  });
  add_option(verb, "name", *name, "which").required().type("FINGER");
}

}  // namespace

void add_finger(CLI::App& app, Command& command) {
  CLI::App& finger = add_family(app, command, "finger", "add, change or remove a finger");
  add_finger_add(finger, command);
  add_finger_set(finger, command);
  add_finger_remove(finger, command);
  set_footer(
      finger,
      "hapticctl finger add thumb --device left --stiffness 100 --fingertip 0.008 0.5 --direction 0 0 1 "
      "--hips 11\n"
      "hapticctl finger set thumb --stiffness 200");
}

}  // namespace haptic::cli
