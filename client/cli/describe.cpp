#include "client/cli/describe.h"

#include <fmt/format.h>

#include <cmath>

namespace haptic::cli {
namespace {

const char* unit_of(v1::FaultKind kind) {
  switch (kind) {
    case v1::FAULT_OVER_SPEED:
      return " m/s";
    case v1::FAULT_STALE_SAMPLE:
    case v1::FAULT_LOST_DRIVER:
    case v1::FAULT_STILL_SAMPLE:
      return " s";
    case v1::FAULT_OVER_TRAVEL:
      return " m";
    case v1::FAULT_ENERGY:
      return " J";
    case v1::FAULT_MISSED_TICKS:
      return " ticks";
    default:
      return "";
  }
}

}  // namespace

std::string describe(v1::FaultKind kind) {
  switch (kind) {
    case v1::FAULT_NONE:
      return "-";
    case v1::FAULT_NOT_FINITE:
      return "not finite";
    case v1::FAULT_OVER_SPEED:
      return "over speed";
    case v1::FAULT_STALE_SAMPLE:
      return "stale sample";
    case v1::FAULT_MISSED_TICKS:
      return "missed ticks";
    case v1::FAULT_LOST_DRIVER:
      return "lost driver";
    case v1::FAULT_OVER_TRAVEL:
      return "over travel";
    case v1::FAULT_ENERGY:
      return "energy";
    case v1::FAULT_EMERGENCY_STOP:
      return "emergency stop";
    case v1::FAULT_STILL_SAMPLE:
      return "still sample";
    case v1::FAULT_LOST_DEVICE:
      return "lost device";
    default:
      return fmt::format("fault {}", static_cast<int>(kind));
  }
}

std::string describe(const v1::Fault& fault) {
  std::string text = fault.device().empty() ? "" : fault.device() + ": ";
  text += describe(fault.kind());
  if (fault.limit() > 0.0 || fault.kind() == v1::FAULT_OVER_TRAVEL) {
    const char* unit = unit_of(fault.kind());
    text += fmt::format(", {:.3g}{} where {:.3g}{} is allowed", fault.value(), unit, fault.limit(), unit);
  }
  return text + fmt::format(" (tick {})", fault.tick());
}

std::string describe(v1::DevicePhase phase) {
  switch (phase) {
    case v1::DEVICE_ABSENT:
      return "absent";
    case v1::DEVICE_FOUND:
      return "found";
    case v1::DEVICE_OPENING:
      return "opening";
    case v1::DEVICE_HOMING:
      return "homing";
    case v1::DEVICE_READY:
      return "ready";
    case v1::DEVICE_ARMED:
      return "armed";
    case v1::DEVICE_FAULT:
      return "fault";
    default:
      return fmt::format("phase {}", static_cast<int>(phase));
  }
}

std::string describe(const v1::RealTime& real_time) {
  std::string text =
      real_time.fifo() ? fmt::format("SCHED_FIFO {}", real_time.priority()) : "no real-time priority";
  if (real_time.has_cpu()) {
    text += fmt::format(", cpu {}", real_time.cpu());
  }
  return text + (real_time.memory_locked() ? ", memory locked" : ", memory not locked");
}

std::string describe(const v1::DriveHolder& holder) {
  const std::string program = holder.program().empty() ? "" : ", " + holder.program();
  return fmt::format("{}{}: a heartbeat within {} ms, the last one {:.0f} ms ago", holder.client(), program,
                     holder.heartbeat_ms(), holder.silence() * 1e3);
}

std::string describe(v1::Event::Kind kind) {
  switch (kind) {
    case v1::Event::ARMED:
      return "armed";
    case v1::Event::DISARMED:
      return "disarmed";
    case v1::Event::PAUSED:
      return "paused";
    case v1::Event::RESUMED:
      return "resumed";
    case v1::Event::FAULT_LATCHED:
      return "fault latched";
    case v1::Event::FAULT_CLEARED:
      return "fault cleared";
    case v1::Event::SCENE_CHANGED:
      return "scene changed";
    case v1::Event::TICKS_MISSED:
      return "ticks missed";
    case v1::Event::FAULT_RECORDED:
      return "fault recorded";
    case v1::Event::DEVICE_CHANGED:
      return "device changed";
    default:
      return fmt::format("event {}", static_cast<int>(kind));
  }
}

const char* name_of(v1::ConstraintState state) {
  switch (state) {
    case v1::TET:
      return "Tet";
    case v1::SUR:
      return "Sur";
    case v1::EDG:
      return "Edg";
    case v1::VER:
      return "Ver";
    case v1::OUT:
      return "Out";
    default:
      return "?";
  }
}

std::string name_of(const v1::Shape& shape) {
  switch (shape.kind_case()) {
    case v1::Shape::kBox:
      return "box";
    case v1::Shape::kIcosphere:
      return "icosphere";
    case v1::Shape::kCylinder:
      return "cylinder";
    case v1::Shape::kExtrusion:
      return "extrusion";
    case v1::Shape::kMesh:
      return "mesh";
    default:
      return "-";
  }
}

std::string duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(seconds);
  const std::uint64_t days = whole / 86400;
  const std::uint64_t hours = whole / 3600 % 24;
  const std::uint64_t minutes = whole / 60 % 60;
  if (days > 0) {
    return fmt::format("{} d {:02} h", days, hours);
  }
  if (hours > 0) {
    return fmt::format("{} h {:02} min", hours, minutes);
  }
  return minutes > 0 ? fmt::format("{} min {:02} s", minutes, whole % 60) : fmt::format("{} s", whole);
}

std::string nanoseconds(double ns) {
  if (ns < 1e3) {
    return fmt::format("{:.0f} ns", ns);
  }
  return ns < 1e6 ? fmt::format("{:.1f} us", ns / 1e3) : fmt::format("{:.2f} ms", ns / 1e6);
}

std::string bytes(std::uint64_t count) {
  const auto value = static_cast<double>(count);
  if (count < 1024) {
    return fmt::format("{} B", count);
  }
  return count < std::uint64_t{1024} * 1024 ? fmt::format("{:.1f} KiB", value / 1024.0)
                                            : fmt::format("{:.1f} MiB", value / (1024.0 * 1024.0));
}

std::string count_of(std::uint64_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string millimetres(double metres) {
  // + 0.0: no negative zero
  return fmt::format("{:+.2f}", std::round(metres * 1e5) / 1e2 + 0.0);
}

}  // namespace haptic::cli
