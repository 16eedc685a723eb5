#pragma once
// What the rest of the daemon lends to its clients' side: the mailbox of the servo thread, what is known from
// the start, and the one thing that takes time, building a scene. Nothing else of the daemon is seen from
// here.

#include <cstdint>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
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

/// Where a client says that a virtual device is: finite, and the rotation a unit quaternion. World frame.
struct DevicePlace {
  std::int64_t time_ns = 0;  // of the servo's clock
  glm::dvec3 position{0.0};  // m
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
  std::optional<glm::dvec3> velocity{};  // m/s; none: the client did not tell
  std::uint32_t buttons = 0;
};

/// What it shall do to its user until then.
struct LiveForce {
  std::int64_t expires_ns = 0;  // of the servo's clock; 0: there is none
  glm::dvec3 force{0.0};        // N
  glm::dvec3 torque{0.0};       // N m
};

/// Places a virtual device and tells the newest force.
using PlaceDevice = std::function<LiveForce(const DevicePlace&)>;

/// What the io thread asks of a device's life; each may wait for the device's thread for a moment.
struct DeviceKeeper {
  std::function<drivers::DeviceState()> state;
  std::function<drivers::DeviceWords()> words;
  std::function<bool(drivers::DeviceAction)> knows;
  std::function<void(drivers::DeviceAction)> request;
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

  /// In the order of the device set; empty for a device that no client can move. io thread, never waits.
  std::vector<PlaceDevice> place_device{};
  /// In the order of the device set; none: the devices are computed, and always there.
  std::vector<DeviceKeeper> keepers{};

  /// Called every few milliseconds while clients are served, if there is one. io thread, must not wait.
  std::function<void()> on_poll{};

  /// Told whenever force is allowed or forbidden. io thread.
  std::function<void(bool armed)> armed_changed{};
};

}  // namespace haptic::ipc
