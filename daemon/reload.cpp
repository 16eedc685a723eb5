#include "daemon/reload.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "load/config_difference.h"
#include "load/config_file.h"

namespace haptic {

ipc::ServerSettings settings_of(const RunOptions& options, const v1::DaemonConfig& config) {
  ipc::ServerSettings settings = ipc::server_settings(config);
  if (!options.socket.empty()) {
    settings.listen.clear();
    settings.listen.emplace_back().mutable_unix()->set_path(options.socket);
  }
  return settings;
}

Reloader::Reloader(RunOptions options, v1::DaemonConfig running, ipc::Server& server)
    : options_(std::move(options)), running_(std::move(running)), server_(server) {}

void Reloader::reload() noexcept {
  try {
    const v1::DaemonConfig wanted = load::load_config(options_.config).message;
    const load::ConfigDifference difference = load::compare(running_, wanted);
    server_.reload(settings_of(options_, wanted));
    running_ = load::after_reload(running_, wanted);
    // certificates are read anew even if the config names the same files
    spdlog::info("{} is read again, with its certificates", options_.config);
    for (const std::string& field : difference.taken_over) spdlog::info("changed: {}", field);
    for (const std::string& field : difference.needs_restart) {
      spdlog::warn("changed, but needs a restart: {}", field);
    }
  } catch (const std::exception& error) {
    spdlog::error("the config stays as it was: {}", error.what());
  }
}

}  // namespace haptic
