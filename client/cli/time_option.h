#pragma once
// Options that are times since the start of a file: "2s", "2" or "200ms".

#include <optional>
#include <string>

#include "client/cli/options.h"

namespace haptic::cli {

/// Adds an option whose value is told in s. Anything that is no time from 0 to 1e9 s is refused.
void add_time(CLI::App& verb, const std::string& name, std::optional<double>& seconds,
              const std::string& help);

}  // namespace haptic::cli
