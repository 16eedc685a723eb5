#pragma once
// One verb, one file: each adds its sub-command, which runs when it is chosen.

#include "client/cli/command.h"

namespace haptic::cli {

void add_status(CLI::App& app, Command& command);
void add_devices(CLI::App& app, Command& command);  // list, show, identify, calibrate, home, reopen
void add_device(CLI::App& app, Command& command);   // move
void add_scene(CLI::App& app, Command& command);    // show, load, save, reset
void add_objects(CLI::App& app, Command& command);
void add_fingers(CLI::App& app, Command& command);
void add_object(CLI::App& app, Command& command);    // add, remove, move, set
void add_material(CLI::App& app, Command& command);  // add, set, remove
void add_gravity(CLI::App& app, Command& command);   // set
void add_finger(CLI::App& app, Command& command);    // add, remove, set
void add_run(CLI::App& app, Command& command);
void add_completion(CLI::App& app, Command& command);  // completion, and __names, which its scripts ask
void add_arm(CLI::App& app, Command& command);         // arm, disarm
void add_lease(CLI::App& app, Command& command);
void add_pause(CLI::App& app, Command& command);  // pause, resume, step
void add_clear(CLI::App& app, Command& command);
void add_faults(CLI::App& app, Command& command);
void add_watch(CLI::App& app, Command& command);
void add_stats(CLI::App& app, Command& command);
void add_record(CLI::App& app, Command& command);
void add_recording(CLI::App& app, Command& command);  // info, recover
void add_export(CLI::App& app, Command& command);
void add_replay(CLI::App& app, Command& command);
void add_certificates(CLI::App& app, Command& command);
void add_plot(CLI::App& app, Command& command);
void add_doctor(CLI::App& app, Command& command);
void add_latency(CLI::App& app, Command& command);

/// All of them, in the order of the help.
void add_verbs(CLI::App& app, Command& command);

/// The parser with everything that hapticctl understands: what the program, a script's lines, completion and
/// the manual pages all have in common.
Parser make_app(Command& command);

}  // namespace haptic::cli
