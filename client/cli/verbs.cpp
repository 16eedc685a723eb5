#include "client/cli/verbs.h"

namespace haptic::cli {

void add_verbs(CLI::App& app, Command& command) {
  add_status(app, command);
  add_devices(app, command);
  add_device(app, command);
  add_scene(app, command);
  add_objects(app, command);
  add_fingers(app, command);
  add_object(app, command);
  add_material(app, command);
  add_gravity(app, command);
  add_finger(app, command);
  add_run(app, command);
  add_watch(app, command);
  add_stats(app, command);
  add_plot(app, command);
  add_record(app, command);
  add_recording(app, command);
  add_export(app, command);
  add_replay(app, command);
  add_arm(app, command);
  add_lease(app, command);
  add_pause(app, command);
  add_faults(app, command);
  add_clear(app, command);
  add_doctor(app, command);
  add_latency(app, command);
  add_certificates(app, command);
  add_completion(app, command);
}

Parser make_app(Command& command) {
  Parser app = make_parser("hapticctl", "Talks to hapticd, the haptics daemon", "hapticctl " HAPTIC_VERSION);
  add_common_options(*app, command);
  add_verbs(*app, command);
  set_footer(
      *app,
      "The daemon is looked for at --socket, else --server, else HAPTICD_SERVER, else HAPTICD_SOCKET, else\n"
      "the system service's socket, else the user's own. HAPTICD_CERTIFICATE, HAPTICD_KEY and\n"
      "HAPTICD_AUTHORITY stand for the options of TLS.\n"
      "Exit codes: 0 done, 1 failed, 2 nothing to do, 3 not found, 4 refused, 5 daemon unreachable,\n"
      "6 protocol mismatch, 7 fault latched, 64 usage.");
  return app;
}

}  // namespace haptic::cli
