#pragma once
// What haptic-view understands, on its command line and in the file that --config names.

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "client/view/gateway.h"

namespace haptic::gateway {

/// What the options are read into.
struct Choice {
  Options options;
  std::string listen = "127.0.0.1:8765";
  std::string page;
  std::string token_file;
  std::string drive_token_file;
};

std::unique_ptr<CLI::App> make_app(Choice& choice);

/// What was chosen, after the app has parsed it. Throws CLI::ValidationError if options do not go together,
/// std::runtime_error if a token cannot be read.
Options options_of(Choice choice);

}  // namespace haptic::gateway
