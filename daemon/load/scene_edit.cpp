#include "load/scene_edit.h"

#include <algorithm>
#include <utility>

#include "load/field_path.h"
#include "load/read_file.h"
#include "load/text_message.h"

namespace haptic::load {
namespace {

using Part = EditedScene::Part;

[[noreturn]] void fail(const std::string& field, const std::string& message) {
  throw LoadError({"", 0, 0, field}, message);
}

std::vector<Part> untouched(int count) {
  std::vector<Part> parts(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].from = static_cast<engine::Index>(i);
  return parts;
}

// One of the scene's lists, with what became of its parts.
template <class Message>
class List {
 public:
  List(const char* noun, google::protobuf::RepeatedPtrField<Message>& messages, std::vector<Part>& parts)
      : noun_(noun), messages_(messages), parts_(parts) {}

  void add(const std::string& field, const Message& message) {
    if (message.name().empty()) fail(field + ".name", std::string("is missing: each ") + noun_ + " has one");
    if (find(message.name()) != kNowhere) {
      fail(field + ".name",
           std::string("there is ") + noun_ + " " + in_quotes(message.name()) + " already: set it instead");
    }
    *messages_.Add() = message;
    parts_.push_back({.from = engine::kNone, .edit = field, .pose = ""});
  }

  void replace(const std::string& field, const Message& message) {
    const int index = at(field + ".name", message.name());
    messages_[index] = message;
    part(index).edit = field;
  }

  void remove(const std::string& field, const std::string& name) {
    const int index = at(field, name);
    messages_.DeleteSubrange(index, 1);
    parts_.erase(parts_.begin() + index);
  }

  /// The index of that name; throws at `field` if there is none.
  int at(const std::string& field, const std::string& name) const {
    const int index = find(name);
    if (index == kNowhere) fail(field, std::string("there is no ") + noun_ + " " + in_quotes(name));
    return index;
  }

  Message& message(int index) { return messages_[index]; }
  Part& part(int index) { return parts_[static_cast<std::size_t>(index)]; }

 private:
  static constexpr int kNowhere = -1;

  int find(const std::string& name) const {
    const auto found = std::find_if(messages_.begin(), messages_.end(),
                                    [&](const Message& message) { return message.name() == name; });
    return found == messages_.end() ? kNowhere : static_cast<int>(found - messages_.begin());
  }

  const char* noun_;
  google::protobuf::RepeatedPtrField<Message>& messages_;
  std::vector<Part>& parts_;
};

class Editor {
 public:
  explicit Editor(EditedScene& edited) : edited_(edited) {}

  void edit(const std::string& field, const v1::SceneEdit& edit) {
    switch (edit.edit_case()) {
      case v1::SceneEdit::kAddObject:
        add_object(field + ".add_object", edit.add_object());
        return;
      case v1::SceneEdit::kRemoveObject:
        objects_.remove(field + ".remove_object", edit.remove_object());
        return;
      case v1::SceneEdit::kMoveObject:
        move_object(field + ".move_object", edit.move_object());
        return;
      case v1::SceneEdit::kSetObject:
        set_object(field + ".set_object", edit.set_object());
        return;
      case v1::SceneEdit::kAddMaterial:
        materials_.add(field + ".add_material", edit.add_material());
        return;
      case v1::SceneEdit::kSetMaterial:
        materials_.replace(field + ".set_material", edit.set_material());
        return;
      case v1::SceneEdit::kRemoveMaterial:
        remove_material(field + ".remove_material", edit.remove_material());
        return;
      case v1::SceneEdit::kSetGravity:
        *edited_.message.mutable_gravity() = edit.set_gravity();
        edited_.gravity = field + ".set_gravity";
        return;
      case v1::SceneEdit::kAddFinger:
        fingers_.add(field + ".add_finger", edit.add_finger());
        return;
      case v1::SceneEdit::kRemoveFinger:
        fingers_.remove(field + ".remove_finger", edit.remove_finger());
        return;
      case v1::SceneEdit::kSetFinger:
        fingers_.replace(field + ".set_finger", edit.set_finger());
        return;
      case v1::SceneEdit::EDIT_NOT_SET:
        break;
    }
    fail(field, "says nothing to do, or what this daemon does not know");
  }

 private:
  static constexpr const char* kNoFiles = "is refused: a scene that is sent cannot name files";

  static bool names_a_file(const v1::Object& object) {
    return object.shape().has_mesh() && !object.shape().mesh().has_embedded();
  }

  void add_object(const std::string& field, const v1::Object& object) {
    if (names_a_file(object)) fail(field + ".shape.mesh.path", kNoFiles);
    objects_.add(field, object);
  }

  void move_object(const std::string& field, const v1::SceneEdit::MoveObject& move) {
    const int index = objects_.at(field + ".name", move.name());
    *objects_.message(index).mutable_pose() = move.pose();
    objects_.part(index).from = engine::kNone;
    objects_.part(index).pose = field + ".pose";
  }

  void set_object(const std::string& field, const v1::SceneEdit::SetObject& set) {
    const int index = objects_.at(field + ".object.name", set.object().name());
    if (set.field_size() == 0) fail(field + ".field", "is missing: expected the fields to be set");
    v1::Object& object = objects_.message(index);
    const std::string shape = object.shape().SerializeAsString();
    Part& part = objects_.part(index);
    for (int i = 0; i < set.field_size(); ++i) {
      const std::string& path = set.field(i);
      take_field(field + "." + item("field", i), path, set.object(), object);
      if (path.substr(0, path.find('.')) != "pose") continue;
      part.from = engine::kNone;
      part.pose.clear();
    }
    part.edit = field + ".object";
    if (names_a_file(object) && object.shape().SerializeAsString() != shape) {
      fail(field + ".object.shape.mesh", kNoFiles);
    }
  }

  void remove_material(const std::string& field, const std::string& name) {
    for (const v1::Object& object : edited_.message.object()) {
      const bool is_region =
          std::any_of(object.region().begin(), object.region().end(),
                      [&](const v1::Object::Region& region) { return region.material() == name; });
      if (object.inside() != name && object.outside() != name && !is_region) continue;
      fail(field, "is refused: object " + in_quotes(object.name()) + " is made of " + in_quotes(name));
    }
    materials_.remove(field, name);
  }

  EditedScene& edited_;
  List<v1::Object> objects_{"object", *edited_.message.mutable_object(), edited_.objects};
  List<v1::Material> materials_{"material", *edited_.message.mutable_material(), edited_.materials};
  List<v1::Finger> fingers_{"finger", *edited_.message.mutable_finger(), edited_.fingers};
};

// "object[3].pose.position.x" is "edit[1].move_object.pose.position.x" of the request; empty if the field is
// of another list, or no edit has set it
std::string blame(const std::string& field, const std::string& list, const std::vector<Part>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string prefix = item(list, static_cast<int>(i));
    if (field.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string rest = field.substr(prefix.size());
    if (!parts[i].pose.empty() && rest.rfind(".pose", 0) == 0) return parts[i].pose + rest.substr(5);
    return parts[i].edit.empty() ? "" : parts[i].edit + rest;
  }
  return "";
}

std::string field_of_request(const EditedScene& edited, const std::string& field) {
  const std::string gravity = "gravity";
  if (!edited.gravity.empty() && field.rfind(gravity, 0) == 0) {
    return edited.gravity + field.substr(gravity.size());
  }
  for (const std::string& found :
       {blame(field, "object", edited.objects), blame(field, "material", edited.materials),
        blame(field, "finger", edited.fingers)}) {
    if (!found.empty()) return found;
  }
  return field;
}

}  // namespace

EditedScene edit_scene(const v1::Scene& scene, const v1::EditScene& request) {
  if (request.edit_size() == 0) fail("edit", "is missing: expected what to do");
  if (request.edit_size() > kMostEdits) {
    fail(item("edit", kMostEdits), "is one too many (permitted: up to " + std::to_string(kMostEdits) + ")");
  }
  check_values(request, TextSource());
  EditedScene edited{.message = scene,
                     .objects = untouched(scene.object_size()),
                     .materials = untouched(scene.material_size()),
                     .fingers = untouched(scene.finger_size()),
                     .gravity = ""};
  Editor editor(edited);
  for (int i = 0; i < request.edit_size(); ++i) editor.edit(item("edit", i), request.edit(i));
  return edited;
}

std::shared_ptr<const LoadedScene> build_edited(const EditedScene& edited, const Built& running,
                                                const v1::Capacity& capacity) {
  try {
    return build_scene(edited.message, TextSource(), nullptr, capacity, &running);
  } catch (const LoadError& error) {
    throw LoadError({"", 0, 0, field_of_request(edited, error.field())}, error.message());
  }
}

std::vector<engine::Index> origins(const std::vector<EditedScene::Part>& parts) {
  std::vector<engine::Index> from;
  from.reserve(parts.size());
  for (const Part& part : parts) from.push_back(part.from);
  return from;
}

}  // namespace haptic::load
