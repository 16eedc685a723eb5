#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "client/cli/describe.h"
#include "client/cli/scene_text.h"
#include "client/cli/table.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

std::string title(const v1::SceneDescription& scene) {
  std::uint64_t hips = 0;
  for (const auto& finger : scene.finger()) {
    hips += finger.hips();
  }
  const std::string name = scene.scene().name();
  return fmt::format("{} (revision {}): {}, {}, {}", name.empty() ? "without a name" : name, scene.revision(),
                     count_of(static_cast<std::uint64_t>(scene.object_size()), "object"),
                     count_of(static_cast<std::uint64_t>(scene.finger_size()), "finger"),
                     count_of(hips, "HIP"));
}

ExitCode show(Command& command) {
  client::Connection& daemon = command.connect();
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_get_scene(); });
  const v1::SceneDescription& scene = response.scene();
  if (command.json) {
    print_json(scene);
    return kDone;
  }
  fmt::print("{}\n", title(scene));
  Table objects(
      {{"object", Align::kLeft}, {"shape", Align::kLeft}, {"cells"}, {"vertices"}, {"size"}, {"mass kg"}});
  for (int i = 0; i < scene.object_size(); ++i) {
    const auto& object = scene.object(i);
    const bool described = i < scene.scene().object_size();
    objects.add({object.name(), described ? name_of(scene.scene().object(i).shape()) : "-",
                 fmt::format("{}", object.cells()), fmt::format("{}", object.vertices()),
                 bytes(object.bytes()),
                 object.mass() > 0.0 ? fmt::format("{:.4g}", object.mass()) : "fixed"});
  }
  Table fingers({{"finger", Align::kLeft}, {"device", Align::kLeft}, {"HIPs"}, {"stiffness N/m"}});
  for (int i = 0; i < scene.finger_size(); ++i) {
    const auto& finger = scene.finger(i);
    const bool described = i < scene.scene().finger_size();
    fingers.add({finger.name(), finger.device(), fmt::format("{}", finger.hips()),
                 described ? fmt::format("{:.6g}", scene.scene().finger(i).stiffness()) : "-"});
  }
  fmt::print("{}", objects.empty() ? "" : "\n" + objects.to_string());
  fmt::print("{}", fingers.empty() ? "" : "\n" + fingers.to_string());
  return kDone;
}

ExitCode load(Command& command, const std::string& path, bool send) {
  client::Connection& daemon = command.connect(std::chrono::minutes(2));
  const v1::Response response = call(daemon, [&](v1::Request& request) {
    if (send) {
      *request.mutable_load_scene()->mutable_scene() = read_scene_text(path);
    } else {
      // the daemon does not run where this program does
      request.mutable_load_scene()->set_path(std::filesystem::absolute(path).lexically_normal().string());
    }
  });
  if (command.json) {
    print_json(response.scene());
  } else {
    fmt::print("loaded {}\n", title(response.scene()));
  }
  return kDone;
}

ExitCode reset(Command& command) {
  client::Connection& daemon = command.connect();
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_reset_scene(); });
  if (command.json) {
    print_json(response.done());
  } else {
    fmt::print("the scene is as it was at its start\n");
  }
  return kDone;
}

ExitCode save(Command& command, const std::string& path, bool force) {
  const v1::Response response =
      call(command.connect(), [](v1::Request& request) { request.mutable_get_scene(); });
  write_scene_text(response.scene().scene(), path, force);
  if (command.json) {
    print_json(response.scene());
  } else {
    fmt::print("saved {} in {}\n", title(response.scene()), path);
  }
  return kDone;
}

void add_save(CLI::App& scene, Command& command) {
  struct Save {
    std::string path;
    bool force = false;
  };
  const auto options = std::make_shared<Save>();
  CLI::App& verb =
      add_verb(scene, command, "save", "write the scene that runs to a file",
               [options](Command& chosen) { return save(chosen, options->path, options->force); });
  add_option(verb, "file", options->path, "a *.scene.txtpb or *.scene.json").required().type("FILE");
  add_flag(verb, "--force", options->force, "replace the file if there is one");
}

}  // namespace

void add_scene(CLI::App& app, Command& command) {
  CLI::App& scene = add_family(app, command, "scene", "show, load, save or reset the scene");
  add_verb(scene, command, "show", "the scene that runs", show);
  add_verb(scene, command, "reset", "all objects back to where they started", reset);
  struct Load {
    std::string path;
    bool send = false;
  };
  const auto options = std::make_shared<Load>();
  CLI::App& verb = add_verb(scene, command, "load", "run another scene", [options](Command& chosen) {
    return load(chosen, options->path, options->send);
  });
  add_option(verb, "file", options->path, "a *.scene.txtpb or *.scene.json").required().type("FILE");
  add_flag(verb, "--send", options->send,
           "read the file here, for a daemon that cannot; its shapes must need no mesh file");
  add_save(scene, command);
}

}  // namespace haptic::cli
