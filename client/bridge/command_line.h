#pragma once
// What haptic-bridge understands, on its command line and in the file that --config names.

#include <CLI/CLI.hpp>
#include <memory>

#include "client/bridge/bridge.h"

namespace haptic::bridge {

/// What the options are read into.
struct Choice {
  Options options;
  bool latest = false;
  bool lossless = false;
};

std::unique_ptr<CLI::App> make_app(Choice& choice);

/// What was chosen, after the app has parsed it: hosts, topics and delivery as the bridge takes them.
Options options_of(Choice choice);

}  // namespace haptic::bridge
