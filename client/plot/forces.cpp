#include "client/plot/forces.h"

namespace haptic::plot {
namespace {

std::array<std::size_t, 3> columns_of_force(const Csv& table, const std::string& prefix) {
  return {table.column(prefix + "x"), table.column(prefix + "y"), table.column(prefix + "z")};
}

void add(const Csv& table, std::size_t row, const std::array<std::size_t, 3>& force, Vector& sum) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sum[axis] += table.number(row, force[axis]);
  }
}

}  // namespace

Forces::Of first_of(const Csv& table) {
  return table.has("finger")   ? Forces::Of::kFingers
         : table.has("device") ? Forces::Of::kDevices
                               : Forces::Of::kObjects;
}

Forces forces_of(const Csv& table, Forces::Of of, const Span& span) {
  const char* const who = of == Forces::Of::kFingers   ? "finger"
                          : of == Forces::Of::kDevices ? "device"
                                                       : "object";
  Forces forces{.of = of};
  const std::size_t time = table.column("time");
  const std::size_t name = table.column(who);
  const auto force = columns_of_force(table, of == Forces::Of::kFingers ? "force_" : "f");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double at = table.number(row, time);
    if (span.has(at)) {
      add(table, row, force, forces.by_name[table.text(row, name)][at]);
    }
  }
  return forces;
}

HipForces hip_forces_of(const Csv& hips, std::optional<double> time) {
  const std::size_t when = hips.column("time");
  const std::size_t finger = hips.column("finger");
  const std::size_t hip = hips.column("hip");
  const auto force = columns_of_force(hips, "force_");
  HipForces forces{.time = -std::numeric_limits<double>::infinity()};
  for (std::size_t row = 0; row < hips.rows(); ++row) {
    const double at = hips.number(row, when);
    forces.time = at > forces.time && (!time || at <= *time) ? at : forces.time;
  }
  for (std::size_t row = 0; row < hips.rows(); ++row) {
    if (hips.number(row, when) == forces.time) {
      add(hips, row, force, forces.by_finger[hips.text(row, finger)][hips.number(row, hip)]);
    }
  }
  return forces;
}

}  // namespace haptic::plot
