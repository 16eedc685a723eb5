#pragma once
// `hapticd run`: the service.

#include <string>

namespace haptic {

struct RunOptions {
  std::string config;
  std::string scene;        // empty: the one that the config names; without one, an empty scene
  std::string socket;       // empty: where the config says
  bool foreground = false;  // log for a person, instead of for a journal
};

/// Serves until SIGINT or SIGTERM, then brings forces down, stops the devices and returns. Throws
/// std::exception with a message for a person if it cannot start.
void run(const RunOptions& options);

}  // namespace haptic
