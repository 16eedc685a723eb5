// Replies of a Haply board: angles are finite, and so is what follows from them.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/haply/haply_kinematics.h"
#include "drivers/haply/haply_protocol.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::drivers;
  const auto angles = haply::decode({data, size});
  if (!angles) return 0;
  for (const haply::Geometry& geometry : {haply::kGeometry2, haply::kGeometry3}) {
    const auto handle = haply::handle_position(geometry, *angles);
    if (handle && !std::isfinite(handle->x + handle->y)) std::abort();
    const auto torques = haply::arm_torques(geometry, *angles, {1.0, -2.0});
    if (torques && !std::isfinite((*torques)[0] + (*torques)[1])) std::abort();
    if (torques && !handle) std::abort();
  }
  return 0;
}
