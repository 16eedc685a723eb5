#include "daemon/scene_builder.h"

#include <filesystem>
#include <utility>

#include "engine/carry_map.h"
#include "load/describe_scene.h"
#include "load/error.h"
#include "load/read_file.h"
#include "load/scene_edit.h"
#include "servo/prepare_scene.h"

namespace haptic {

namespace {

v1::SceneDescription::Carry describe(const servo::Carry& carry) {
  v1::SceneDescription::Carry told;
  told.set_from_revision(carry.from_revision);
  for (const engine::CarriedObject& object : carry.map.objects) {
    v1::SceneDescription::Carry::Object& item = *told.add_object();
    if (object.from != engine::kNone) item.set_from(object.from);
    item.set_motion(object.motion);
    item.set_contacts(object.contacts);
  }
  for (const engine::Index from : carry.map.fingers) {
    v1::SceneDescription::Carry::Part& item = *told.add_finger();
    if (from != engine::kNone) item.set_from(from);
  }
  return told;
}

v1::Error to_wire(const load::LoadError& error) {
  v1::Error wire;
  wire.set_code(v1::Error::INVALID);
  wire.set_message(error.message());
  wire.set_field(error.field());
  wire.set_file(error.file());
  wire.set_line(error.line());
  wire.set_column(error.column());
  return wire;
}

}  // namespace

SceneBuilder::SceneBuilder(v1::Capacity capacity, std::vector<std::string> devices)
    : capacity_(std::move(capacity)), devices_(std::move(devices)) {}

ipc::BuiltScene SceneBuilder::from_file(const std::string& file) const {
  if (file.empty()) return finish(std::make_shared<const load::LoadedScene>());
  ipc::BuiltScene built = finish(load::load_scene(file, capacity_));
  for (v1::Object& object : *built.description.mutable_scene()->mutable_object()) {
    if (!object.shape().has_mesh()) continue;
    std::string& path = *object.mutable_shape()->mutable_mesh()->mutable_path();
    path = std::filesystem::absolute(load::relative_to(file, path)).lexically_normal().string();
  }
  return built;
}

ipc::BuiltScene SceneBuilder::from_request(const v1::LoadScene& request) const {
  try {
    if (request.has_scene()) return finish(load::build_scene(request.scene(), capacity_));
    std::error_code ignored;
    if (std::filesystem::exists(request.path(), ignored) && !request.path().empty()) {
      return from_file(request.path());
    }
  } catch (const load::LoadError& error) {
    throw ipc::SceneError(to_wire(error));
  }
  v1::Error missing;
  missing.set_code(v1::Error::NOT_FOUND);
  missing.set_message("there is no such file on the daemon's machine");
  missing.set_file(request.path());
  throw ipc::SceneError(std::move(missing));
}

ipc::BuiltScene SceneBuilder::from_edit(const v1::EditScene& request,
                                        const ipc::RunningScene& running) const {
  try {
    const load::EditedScene edited = load::edit_scene(running.message, request);
    ipc::BuiltScene built = finish(load::build_edited(edited, {running.message, *running.scene}, capacity_));
    built.prepared->carry = servo::Carry{
        .from_revision = running.revision,
        .map = engine::make_carry_map(*running.scene, built.prepared->world.scene(),
                                      load::origins(edited.objects), load::origins(edited.fingers))};
    *built.description.mutable_carry() = describe(*built.prepared->carry);
    return built;
  } catch (const load::LoadError& error) {
    throw ipc::SceneError(to_wire(error));
  }
}

ipc::BuiltScene SceneBuilder::finish(const std::shared_ptr<const load::LoadedScene>& loaded) const {
  constexpr std::uint64_t kNotYetNumbered = 0;
  const std::shared_ptr<const engine::Scene> scene(loaded, &loaded->scene);
  return {.prepared = servo::prepare_scene(scene, kNotYetNumbered, devices_),
          .description = load::describe(*loaded)};
}

}  // namespace haptic
