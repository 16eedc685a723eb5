#include <fmt/format.h>

#include <memory>

#include "client/cli/edit.h"
#include "client/cli/verbs.h"

namespace haptic::cli {

void add_gravity(CLI::App& app, Command& command) {
  CLI::App& gravity = add_family(app, command, "gravity", "set gravity");
  const auto value = std::make_shared<v1::Vector3>();
  CLI::App& verb =
      add_verb(gravity, command, "set", "what pulls at dynamic objects", [value](Command& chosen) {
        v1::SceneEdit edit;
        *edit.mutable_set_gravity() = *value;
        return send_edit(chosen, edit,
                         fmt::format("gravity is {} {} {} m/s^2", value->x(), value->y(), value->z()));
      });
  const auto axis = [&](const char* name, void (v1::Vector3::*set)(double)) {
    add_number(verb, name, "m/s^2", [value, set](double number) { ((*value).*set)(number); }).required();
  };
  axis("x", &v1::Vector3::set_x);
  axis("y", &v1::Vector3::set_y);
  axis("z", &v1::Vector3::set_z);
}

}  // namespace haptic::cli
