#pragma once
// One verb, one file: each adds its sub-command, which runs when it is chosen.

#include "client/cli/command.h"

namespace haptic::cli {

void add_status(CLI::App& app, Command& command);
void add_devices(CLI::App& app, Command& command);
void add_scene(CLI::App& app, Command& command);  // show, load, reset
void add_objects(CLI::App& app, Command& command);
void add_fingers(CLI::App& app, Command& command);
void add_arm(CLI::App& app, Command& command);    // arm, disarm
void add_pause(CLI::App& app, Command& command);  // pause, resume, step
void add_clear(CLI::App& app, Command& command);
void add_watch(CLI::App& app, Command& command);
void add_stats(CLI::App& app, Command& command);
void add_certificates(CLI::App& app, Command& command);

/// All of them, in the order of the help.
void add_verbs(CLI::App& app, Command& command);

}  // namespace haptic::cli
