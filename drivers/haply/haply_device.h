#pragma once
// A Haply 2DIY pantograph on its board's serial port. It moves in the plane of x and y; force along z is not
// felt. What the board does when requests stop is not known: zero torque goes out several times at the end.

#include <chrono>
#include <memory>
#include <string>

#include "drivers/device_link.h"
#include "drivers/haply/haply_kinematics.h"
#include "drivers/haply/haply_protocol.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::haply {

struct HaplySettings {
  std::string name;
  std::string port;  // e.g. "/dev/ttyACM0"
  Wiring wiring = kWiring3;
  Geometry geometry = kGeometry3;
  double max_force = 0.0;  // N
  BasePose world_from_base{};
  std::chrono::milliseconds reply{20};  // without one in this time the stream is drained and begun anew
};

std::unique_ptr<Device> make_haply(HaplySettings settings);

}  // namespace haptic::drivers::haply
