#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <vector>

#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

// the engine is the daemon's: beside this program when installed, elsewhere in the tree where it was built
std::string find_hapticd() {
  std::error_code ignored;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const char* const place : {"hapticd", "../../daemon/hapticd"}) {
    const std::filesystem::path candidate = self / place;
    if (::access(candidate.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(candidate, ignored)) {
      return candidate.lexically_normal();
    }
  }
  return "hapticd";  // wherever PATH has it
}

ExitCode replay(const Command& command, const std::string& file) {
  const std::string program = find_hapticd();
  std::vector<std::string> words = {"hapticd", "simulate", "--replay=" + file};
  if (command.json) words.emplace_back("--json");
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  std::fflush(stdout);
  pid_t child = 0;
  const int refused = ::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ);
  if (refused != 0) {
    fmt::print(stderr,
               "hapticctl: a replay runs in hapticd, which is neither beside hapticctl nor in PATH: {}\n",
               std::generic_category().message(refused));
    return kNotFound;
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? kDone : kFailed;
}

}  // namespace

void add_replay(CLI::App& app, Command& command) {
  const auto file = std::make_shared<std::string>();
  CLI::App& verb =
      add_verb(app, command, "replay", "run a recording again and compare every tick, to the bit",
               [file](Command& chosen) { return replay(chosen, *file); });
  add_option(verb, "file", *file, "a recording, as record writes it").required().type("FILE");
  set_footer(
      verb,
      "The inputs of the recording go through the tick of hapticd, which must be installed here; no daemon "
      "need\n"
      "run. After each tick the hash of the state is compared with the recorded one, and the first that "
      "differs\n"
      "is named with the object or the HIP, as far as the recording tells. Exit code 0: all that can be "
      "replayed\n"
      "is the same; 1: something differs, or nothing can be replayed.");
}

}  // namespace haptic::cli
