#include <memory>

#include "client/cli/edit.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

void add_material_add(CLI::App& material, Command& command) {
  const auto changes = std::make_shared<Changes<v1::Material>>();
  CLI::App& verb = add_verb(material, command, "add", "a material more", [changes](Command& chosen) {
    v1::SceneEdit edit;
    *edit.mutable_add_material() = changes->applied_to({});
    return send_edit(chosen, edit, "added material " + edit.add_material().name());
  });
  add_material_options(verb, *changes, Editing::kAdd);
}

// the message replaces all of it, so that what is not told is taken from the scene, which must not change
// meanwhile
void add_material_set(CLI::App& material, Command& command) {
  const auto changes = std::make_shared<Changes<v1::Material>>();
  CLI::App& verb = add_verb(material, command, "set", "change what it is", [changes](Command& chosen) {
    const v1::SceneDescription scene = ask_scene(chosen);
    const v1::SceneEdit edit = set_material_edit(scene.scene(), *changes);
    return send_edit(chosen, edit, "changed material " + edit.set_material().name(), scene.revision());
  });
  add_material_options(verb, *changes, Editing::kSet);
}

void add_material_remove(CLI::App& material, Command& command) {
  const auto name = std::make_shared<std::string>();
  CLI::App& verb =
      add_verb(material, command, "remove", "a material less; refused while an object is made of it",
               [name](Command& chosen) {
                 v1::SceneEdit edit;
                 edit.set_remove_material(*name);
                 return send_edit(chosen, edit, "removed material " + *name);
               });
  add_option(verb, "name", *name, "which").required().type("MATERIAL");
}

}  // namespace

void add_material(CLI::App& app, Command& command) {
  CLI::App& material = add_family(app, command, "material", "add, change or remove a material");
  add_material_add(material, command);
  add_material_set(material, command);
  add_material_remove(material, command);
  set_footer(material,
             "hapticctl material add wood --density 500 --rigid 1.0 0.5\n"
             "hapticctl material set wood --density 700");
}

}  // namespace haptic::cli
