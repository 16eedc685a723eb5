#include <fmt/format.h>

#include <memory>

#include "client/cli/completion.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

constexpr const char* kShells = "bash|zsh|fish";

ExitCode print_completion(const std::string& shell) {
  Command unused;
  const Parser app = make_app(unused);
  const std::vector<CompletedVerb> verbs = completed_verbs(*app);
  const std::string script = shell == "bash"  ? bash_completion(verbs)
                             : shell == "zsh" ? zsh_completion(verbs)
                                              : fish_completion(verbs);
  std::fwrite(script.data(), 1, script.size(), stdout);
  return kDone;
}

// what a person who waits for a list has patience for
constexpr std::chrono::milliseconds kCompletionPatience{300};

std::vector<std::string> names_of_kind(Command& command, const std::string& kind) {
  std::vector<std::string> names;
  const auto take = [&names](const auto& items) {
    for (const auto& item : items) {
      names.push_back(item.name());
    }
  };
  client::Connection& daemon = command.connect(kCompletionPatience);
  if (kind == "DEVICE") {
    const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_list_devices(); });
    for (const v1::DeviceStatus& device : response.devices().device()) {
      names.push_back(device.description().name());
    }
    return names;
  }
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_get_scene(); });
  const v1::SceneDescription& scene = response.scene();
  if (kind == "OBJECT") {
    take(scene.object());
  } else if (kind == "FINGER") {
    take(scene.finger());
  } else {
    take(scene.scene().material());
  }
  return names;
}

ExitCode print_names(Command& command, const std::string& kind) {
  try {
    for (const std::string& name : names_of_kind(command, kind)) {
      fmt::print("{}\n", name);
    }
  } catch (const client::Error&) {
    // a shell that completes has no place for errors
  }
  return kDone;
}

}  // namespace

void add_completion(CLI::App& app, Command& command) {
  const auto shell = std::make_shared<std::string>();
  CLI::App& completion =
      add_verb(app, command, "completion", "a script with which a shell completes arguments",
               [shell](Command&) { return print_completion(*shell); });
  add_option(completion, "shell", *shell, "for which shell")
      .required()
      .one_of({"bash", "zsh", "fish"})
      .type(kShells);
  set_footer(completion,
             "bash: hapticctl completion bash > ~/.local/share/bash-completion/completions/hapticctl\n"
             "zsh:  hapticctl completion zsh > a file _hapticctl in a folder of $fpath\n"
             "fish: hapticctl completion fish > ~/.config/fish/completions/hapticctl.fish");

  const auto kind = std::make_shared<std::string>();
  CLI::App& names = add_verb(app, command, "__names", "names that completion asks for",
                             [kind](Command& chosen) { return print_names(chosen, *kind); });
  hide(names);
  add_option(names, "kind", *kind, "OBJECT, FINGER, DEVICE or MATERIAL")
      .required()
      .one_of({"OBJECT", "FINGER", "DEVICE", "MATERIAL"});
}

}  // namespace haptic::cli
