#include "client/cli/verbs.h"

namespace haptic::cli {

void add_verbs(CLI::App& app, Command& command) {
  add_status(app, command);
  add_devices(app, command);
  add_scene(app, command);
  add_objects(app, command);
  add_fingers(app, command);
  add_watch(app, command);
  add_stats(app, command);
  add_arm(app, command);
  add_pause(app, command);
  add_clear(app, command);
  add_certificates(app, command);
}

}  // namespace haptic::cli
