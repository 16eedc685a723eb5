#pragma once
// What the rest of the daemon lends to its clients' side: the mailbox of the servo thread, what is known from
// the start, and the one thing that takes time, building a scene. Nothing else of the daemon is seen from
// here.

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "servo/mailbox.h"

namespace haptic::ipc {

/// A scene that is ready to run, and what is told about it. The revision in both is set when it is swapped
/// in.
struct BuiltScene {
  std::unique_ptr<servo::PreparedScene> prepared;
  v1::SceneDescription description;
};

/// What an edit starts from: the scene that runs.
struct RunningScene {
  v1::Scene message;
  std::shared_ptr<const engine::Scene> scene;  // what was built of it
  std::uint64_t revision = 0;
};

/// A scene that cannot be built: what is sent to the client that asked for it.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(v1::Error error) : std::runtime_error(error.message()), wire(std::move(error)) {}
  v1::Error wire;
};

struct Services {
  servo::Mailbox& mailbox;
  std::string version;
  double rate_hz = 1000.0;
  std::vector<v1::DeviceDescription> devices;    // in the order of the device set; fingers are filled in here
  v1::RealTime real_time;                        // what the servo thread asked for and got
  v1::SceneDescription scene;                    // what runs at the start, with its revision
  std::shared_ptr<const engine::Scene> running;  // the same, as it was built

  /// Builds what the client asked for. Called on a thread that may take its time, one call at a time. Throws
  /// SceneError.
  std::function<BuiltScene(const v1::LoadScene&)> build_scene;
  /// The same for the scene that runs with the client's edits done.
  std::function<BuiltScene(const v1::EditScene&, const RunningScene&)> edit_scene;
};

}  // namespace haptic::ipc
