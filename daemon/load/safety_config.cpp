#include "load/safety_config.h"

#include "load/ranges.h"
#include "load/scene_parts.h"

namespace haptic::load {

namespace {

constexpr Range kForces{0.0, 1000.0, " N", true};
constexpr Range kForceRates{0.0, 1e6, " N/s", true};
constexpr Range kSpeeds{0.0, 100.0, " m/s", true};
constexpr Range kEnergies{0.0, 1e6, " J", true};
constexpr Range kScales{0.001, 1000.0};
constexpr std::uint32_t kLastButton = 31;

/// Fills in `fallback` for a field that was left away, and checks what was not.
void number(const TextSource& source, const std::string& field, double value, double fallback,
            const Range& range, auto set) {
  if (value == 0.0) return set(fallback);
  check_range(source, field, value, range);
}

/// For a field whose 0 means that there is no such limit.
void optional_number(const TextSource& source, const std::string& field, double value, const Range& range) {
  if (value != 0.0) check_range(source, field, value, range);
}

void check_travel(const TextSource& source, const std::string& field, const v1::Device::Limits::Box& box) {
  if (!box.has_min()) source.fail(field + ".min", "is missing: a box has two corners");
  if (!box.has_max()) source.fail(field + ".max", "is missing: a box has two corners");
  const glm::dvec3 min = make_point(source, field + ".min", box.min());
  const glm::dvec3 max = make_point(source, field + ".max", box.max());
  constexpr const char* kAxes[] = {".x", ".y", ".z"};
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    if (min[axis] < max[axis]) continue;
    source.fail(field + ".max" + kAxes[axis],
                to_text(max[axis]) + " is not above that of min, which is " + to_text(min[axis]));
  }
}

void check_limits(const TextSource& source, const std::string& field, const v1::Device::Limits& limits) {
  optional_number(source, field + ".max_force", limits.max_force(), kForces);
  optional_number(source, field + ".max_force_rate", limits.max_force_rate(), kForceRates);
  optional_number(source, field + ".max_speed", limits.max_speed(), kSpeeds);
  optional_number(source, field + ".max_mean_force", limits.max_mean_force(), kForces);
  optional_number(source, field + ".max_energy", limits.max_energy(), kEnergies);
  if (limits.has_travel()) check_travel(source, field + ".travel", limits.travel());
}

/// Whose driver computes the velocity, or is told it, better than positions tell it.
bool tells_velocity(const v1::Device& device) {
  return device.has_simulated() || device.has_playback() || device.has_virtual_() || device.has_external() ||
         device.has_spacemouse();
}

void check_filter(const TextSource& source, const std::string& field, const v1::Device& device,
                  v1::Device::MotionFilter& filter) {
  using Filter = v1::Device::MotionFilter;
  if (filter.kind() == Filter::KIND_UNSPECIFIED) {
    filter.set_kind(tells_velocity(device) ? Filter::DRIVER : Filter::ADAPTIVE_WINDOW);
  }
  if (filter.kind() < Filter::ADAPTIVE_WINDOW || filter.kind() > Filter::DRIVER) {
    source.fail(field + ".kind", "is no filter (permitted: ADAPTIVE_WINDOW, LOW_PASS, DRIVER)");
  }
  const bool is_window = filter.kind() == Filter::ADAPTIVE_WINDOW;
  const bool is_low_pass = filter.kind() == Filter::LOW_PASS;
  if (filter.window() != 0.0 && !is_window) source.fail(field + ".window", "is of ADAPTIVE_WINDOW only");
  if (filter.noise() != 0.0 && !is_window) source.fail(field + ".noise", "is of ADAPTIVE_WINDOW only");
  if (filter.cutoff() != 0.0 && !is_low_pass) source.fail(field + ".cutoff", "is of LOW_PASS only");
  if (is_window) {
    number(source, field + ".window", filter.window(), 0.02, {0.001, 0.1, " s"},
           [&](double v) { filter.set_window(v); });
    number(source, field + ".noise", filter.noise(), 2e-5, {0.0, 0.01, " m", true},
           [&](double v) { filter.set_noise(v); });
  }
  if (is_low_pass) {
    number(source, field + ".cutoff", filter.cutoff(), 40.0, {0.1, 4000.0, " Hz"},
           [&](double v) { filter.set_cutoff(v); });
  }
}

}  // namespace

void check_safety(const TextSource& source, v1::Safety& safety) {
  number(source, "safety.max_force", safety.max_force(), 5.0, kForces,
         [&](double v) { safety.set_max_force(v); });
  number(source, "safety.max_force_rate", safety.max_force_rate(), 500.0, kForceRates,
         [&](double v) { safety.set_max_force_rate(v); });
  number(source, "safety.max_speed", safety.max_speed(), 2.0, kSpeeds,
         [&](double v) { safety.set_max_speed(v); });
  number(source, "safety.arm_ramp", safety.arm_ramp(), 0.5, {0.0, 60.0, " s", true},
         [&](double v) { safety.set_arm_ramp(v); });
  number(source, "safety.max_sample_age", safety.max_sample_age(), 0.02, {0.0, 10.0, " s", true},
         [&](double v) { safety.set_max_sample_age(v); });
  if (safety.max_missed_ticks() == 0) safety.set_max_missed_ticks(50);
  check_range(source, "safety.max_missed_ticks", safety.max_missed_ticks(), {1, 1000000});
  optional_number(source, "safety.max_mean_force", safety.max_mean_force(), kForces);
  number(source, "safety.mean_force_time", safety.mean_force_time(), 10.0, {0.1, 3600.0, " s"},
         [&](double v) { safety.set_mean_force_time(v); });
  number(source, "safety.max_energy", safety.max_energy(), 1.0, kEnergies,
         [&](double v) { safety.set_max_energy(v); });
  number(source, "safety.max_arm_force", safety.max_arm_force(), 0.5, kForces,
         [&](double v) { safety.set_max_arm_force(v); });
  optional_number(source, "safety.max_still", safety.max_still(), {0.01, 3600.0, " s"});
}

void check_device_safety(const TextSource& source, const std::string& field, v1::Device& device) {
  check_limits(source, field + ".limits", device.limits());
  v1::Device::Workspace& workspace = *device.mutable_workspace();
  const std::string at = field + ".workspace";
  number(source, at + ".scale", workspace.scale(), 1.0, kScales, [&](double v) { workspace.set_scale(v); });
  number(source, at + ".force_scale", workspace.force_scale(), 1.0, kScales,
         [&](double v) { workspace.set_force_scale(v); });
  if (workspace.has_clutch_button()) {
    check_range(source, at + ".clutch_button", workspace.clutch_button(), {0, kLastButton});
  }
  check_filter(source, at + ".filter", device, *workspace.mutable_filter());
  if (!device.has_stop_button()) return;
  check_range(source, field + ".stop_button", device.stop_button(), {0, kLastButton});
  if (workspace.has_clutch_button() && workspace.clutch_button() == device.stop_button()) {
    source.fail(field + ".stop_button", "is also the clutch");
  }
}

}  // namespace haptic::load
