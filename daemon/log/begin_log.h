#pragma once
// Where the daemon's log goes: standard error, as the journal or a person wants it, and a file.

#include "haptic/v1/config.pb.h"

namespace haptic::log {

/// From now on spdlog's default logger writes to standard error - with fields if that is the journal, with
/// times if `foreground`, and else with the priority at the beginning of the line - and to the file of the
/// config. Every field of `config` that has a default must be set, as load_config() does. Throws
/// std::runtime_error if the file cannot be written.
void begin_log(const v1::Log& config, bool foreground);

}  // namespace haptic::log
