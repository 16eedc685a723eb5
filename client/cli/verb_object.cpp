#include <memory>

#include "client/cli/edit.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

void add_object_add(CLI::App& object, Command& command) {
  const auto changes = std::make_shared<Changes<v1::Object>>();
  CLI::App& verb = add_verb(object, command, "add", "an object more", [changes](Command& chosen) {
    v1::SceneEdit edit;
    *edit.mutable_add_object() = changes->applied_to({});
    return send_edit(chosen, edit, "added object " + edit.add_object().name());
  });
  add_object_options(verb, *changes, Editing::kAdd);
}

void add_object_remove(CLI::App& object, Command& command) {
  const auto name = std::make_shared<std::string>();
  CLI::App& verb = add_verb(object, command, "remove", "an object less", [name](Command& chosen) {
    v1::SceneEdit edit;
    edit.set_remove_object(*name);
    return send_edit(chosen, edit, "removed object " + *name);
  });
  add_option(verb, "name", *name, "which").required().type("OBJECT");
}

// where it is not told it stays as it is
void fill_pose(v1::Pose& pose, const v1::Pose& now) {
  if (!pose.has_position()) {
    *pose.mutable_position() = now.position();
  }
  if (!pose.has_orientation()) {
    *pose.mutable_orientation() = now.orientation();
  }
}

void add_move(CLI::App& object, Command& command) {
  const auto move = std::make_shared<v1::SceneEdit::MoveObject>();
  CLI::App& verb = add_verb(object, command, "move", "put it elsewhere, at rest", [move](Command& chosen) {
    v1::SceneEdit edit;
    v1::SceneEdit::MoveObject& wire = *edit.mutable_move_object();
    wire = *move;
    if (!move->pose().has_position() || !move->pose().has_orientation()) {
      fill_pose(*wire.mutable_pose(), ask_pose(chosen, move->name()));
    }
    return send_edit(chosen, edit, "moved object " + move->name());
  });
  add_text(verb, "name", "which", [move](const std::string& name) { move->set_name(name); })
      .required()
      .type("OBJECT");
  add_pose_options(verb, [move](const PoseChange& change) { change(*move->mutable_pose()); });
  when_read(verb, [move] {
    if (!move->pose().has_position() && !move->pose().has_orientation()) {
      refuse_without("--at or --turn");
    }
  });
}

void add_object_set(CLI::App& object, Command& command) {
  const auto changes = std::make_shared<Changes<v1::Object>>();
  CLI::App& verb = add_verb(object, command, "set", "change what it is", [changes](Command& chosen) {
    const v1::SceneEdit edit = set_object_edit(*changes);
    return send_edit(chosen, edit, "changed object " + edit.set_object().object().name());
  });
  add_object_options(verb, *changes, Editing::kSet);
}

}  // namespace

void add_object(CLI::App& app, Command& command) {
  CLI::App& object = add_family(app, command, "object", "add, remove, move or change an object");
  add_object_add(object, command);
  add_object_remove(object, command);
  add_move(object, command);
  add_object_set(object, command);
  set_footer(
      object,
      "hapticctl object add box1 --box 0.08 0.03 0.03 --inside wood --outside air --air-margin 0.02 \\\n"
      "    --at 0 0.05 0 --dynamic --linear-viscosity 0.8\n"
      "hapticctl object move box1 --at 0 0.1 0\n"
      "hapticctl object set box1 --inside stone");
}

}  // namespace haptic::cli
