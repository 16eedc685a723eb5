#include "client/cli/edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "client/cli/look.h"
#include "client/lib/error.h"

namespace haptic::cli {
namespace {

// building the cells of a large object takes the daemon a while
constexpr std::chrono::minutes kPatience{2};

[[noreturn]] void throw_unknown(const char* kind, const std::string& name) {
  v1::Error error;
  error.set_code(v1::Error::NOT_FOUND);
  error.set_message(fmt::format("there is no {} \"{}\"", kind, name));
  client::throw_error(error);
}

// the item of that name with the changes made
template <typename Message>
Message changed(const google::protobuf::RepeatedPtrField<Message>& items, const Changes<Message>& changes,
                const char* kind) {
  const std::string name = changes.applied_to({}).name();
  for (const Message& item : items) {
    if (item.name() == name) {
      return changes.applied_to(item);
    }
  }
  throw_unknown(kind, name);
}

}  // namespace

v1::SceneEdit set_object_edit(const Changes<v1::Object>& changes) {
  v1::SceneEdit edit;
  v1::SceneEdit::SetObject& set = *edit.mutable_set_object();
  *set.mutable_object() = changes.applied_to({});
  for (const std::string& field : changes.fields) {
    if (std::find(set.field().begin(), set.field().end(), field) == set.field().end()) {
      set.add_field(field);
    }
  }
  return edit;
}

v1::SceneEdit set_material_edit(const v1::Scene& scene, const Changes<v1::Material>& changes) {
  v1::SceneEdit edit;
  *edit.mutable_set_material() = changed(scene.material(), changes, "material");
  return edit;
}

v1::SceneEdit set_finger_edit(const v1::Scene& scene, const Changes<v1::Finger>& changes) {
  v1::SceneEdit edit;
  *edit.mutable_set_finger() = changed(scene.finger(), changes, "finger");
  return edit;
}

ExitCode send_edit(Command& command, const v1::SceneEdit& edit, const std::string& what,
                   std::uint64_t revision) {
  const v1::Response response = call(command.connect(kPatience), [&](v1::Request& request) {
    *request.mutable_edit_scene()->add_edit() = edit;
    request.mutable_edit_scene()->set_expected_revision(revision);
  });
  if (!command.json) {
    const std::uint64_t now = response.scene().revision();
    fmt::print("{}{}\n", what, now > 0 ? fmt::format(" (revision {})", now) : "");
  } else if (response.has_scene()) {
    print_json(response.scene());
  } else {
    print_json(response.done());
  }
  return kDone;
}

v1::Pose ask_pose(Command& command, const std::string& object) {
  const Look look = look_once(command.connect(), v1::OBJECTS);
  const auto found = std::find(look.names.objects.begin(), look.names.objects.end(), object);
  if (found == look.names.objects.end()) {
    throw_unknown("object", object);
  }
  const int i = static_cast<int>(found - look.names.objects.begin());
  const v1::ObjectsFrame& frame = look.frame.objects();
  v1::Pose pose;
  if (frame.position_size() >= 3 * (i + 1) && frame.orientation_size() >= 4 * (i + 1)) {
    pose.mutable_position()->set_x(frame.position(3 * i));
    pose.mutable_position()->set_y(frame.position(3 * i + 1));
    pose.mutable_position()->set_z(frame.position(3 * i + 2));
    pose.mutable_orientation()->set_w(frame.orientation(4 * i));
    pose.mutable_orientation()->set_x(frame.orientation(4 * i + 1));
    pose.mutable_orientation()->set_y(frame.orientation(4 * i + 2));
    pose.mutable_orientation()->set_z(frame.orientation(4 * i + 3));
  }
  return pose;
}

v1::SceneDescription ask_scene(Command& command) {
  v1::Response response = call(command.connect(), [](v1::Request& request) { request.mutable_get_scene(); });
  return std::move(*response.mutable_scene());
}

}  // namespace haptic::cli
