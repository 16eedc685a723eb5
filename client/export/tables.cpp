#include "client/export/tables.h"

#include <algorithm>

namespace haptic::exporting {
namespace {

constexpr Column kTick{"tick", "tick", Kind::kCount, "", ""};
constexpr Column kTime{"time", "time", Kind::kNumber, "s", ""};
constexpr Column kFinger{"finger", "finger", Kind::kName, "", ""};
constexpr Column kHip{"hip", "hip", Kind::kCount, "", ""};
constexpr Column kObject{"object", "object", Kind::kName, "", ""};
constexpr Column kState{"state", "state", Kind::kName, "", ""};
constexpr Column kSlipping{"slipping", "slipping", Kind::kFlag, "", ""};
constexpr Column kHipPosition{"hip_x,hip_y,hip_z", "hip_position", Kind::kNumber, "m", "world"};
constexpr Column kProxyPosition{"proxy_x,proxy_y,proxy_z", "proxy_position", Kind::kNumber, "m", "world"};
constexpr Column kHipForce{"force_x,force_y,force_z", "force", Kind::kNumber, "N", "world"};
constexpr Column kPosition{"x,y,z", "position", Kind::kNumber, "m", "world"};
constexpr Column kOrientation{"qw,qx,qy,qz", "orientation", Kind::kNumber, "", "world"};
constexpr Column kVelocity{"vx,vy,vz", "velocity", Kind::kNumber, "m/s", "world"};
constexpr Column kAngularVelocity{"wx,wy,wz", "angular_velocity", Kind::kNumber, "rad/s", "world"};
constexpr Column kForce{"fx,fy,fz", "force", Kind::kNumber, "N", "world"};
constexpr Column kTorque{"tx,ty,tz", "torque", Kind::kNumber, "N m", "world"};

constexpr Column kHips[] = {kTick,  kTime,     kFinger,      kHip,           kObject,
                            kState, kSlipping, kHipPosition, kProxyPosition, kHipForce};
constexpr Column kObjects[] = {kTick,  kTime,  kObject, kPosition, kOrientation, kVelocity, kAngularVelocity,
                               kForce, kTorque};
constexpr Column kDevices[] = {kTick,
                               kTime,
                               {"device", "device", Kind::kName, "", ""},
                               kPosition,
                               kOrientation,
                               kForce,
                               kTorque,
                               {"armed", "armed", Kind::kFlag, "", ""},
                               {"fault", "fault", Kind::kName, "", ""},
                               kVelocity,
                               {"sample_age", "sample_age", Kind::kNumber, "s", ""},
                               {"buttons", "buttons", Kind::kCount, "", ""},
                               {"present", "present", Kind::kFlag, "", ""}};
constexpr Column kContacts[] = {kTick,  kTime,     kFinger,        kHip,     kObject,
                                kState, kSlipping, kProxyPosition, kHipForce};
constexpr Column kEvents[] = {kTick,
                              kTime,
                              {"kind", "kind", Kind::kName, "", ""},
                              {"fault", "fault", Kind::kName, "", ""},
                              {"device", "device", Kind::kName, "", ""},
                              {"scene_revision", "scene_revision", Kind::kCount, "", ""},
                              {"message", "message", Kind::kText, "", ""}};
constexpr Column kStats[] = {kTick,
                             kTime,
                             {"missed_ticks", "missed_ticks", Kind::kCount, "", ""},
                             {"lost_snapshots", "lost_snapshots", Kind::kCount, "", ""},
                             {"stage", "stage", Kind::kName, "", ""},
                             {"count", "count", Kind::kCount, "", ""},
                             {"mean_ns", "mean_ns", Kind::kNumber, "ns", ""},
                             {"p50_ns", "p50_ns", Kind::kCount, "ns", ""},
                             {"p99_ns", "p99_ns", Kind::kCount, "ns", ""},
                             {"p999_ns", "p999_ns", Kind::kCount, "ns", ""},
                             {"max_ns", "max_ns", Kind::kCount, "ns", ""}};
constexpr Column kGaps[] = {{"first_tick", "first_tick", Kind::kCount, "", ""},
                            {"last_tick", "last_tick", Kind::kCount, "", ""},
                            {"frames", "frames", Kind::kCount, "", ""}};

}  // namespace

std::string_view name_of(Topic topic) {
  constexpr std::string_view kNames[] = {"hips", "objects", "devices", "contacts", "events", "stats", "gaps"};
  return kNames[static_cast<std::size_t>(topic)];
}

std::span<const Column> columns_of(Topic topic) {
  switch (topic) {
    case Topic::kHips:
      return kHips;
    case Topic::kObjects:
      return kObjects;
    case Topic::kDevices:
      return kDevices;
    case Topic::kContacts:
      return kContacts;
    case Topic::kEvents:
      return kEvents;
    case Topic::kStats:
      return kStats;
    case Topic::kGaps:
      break;
  }
  return kGaps;
}

std::size_t width_of(const Column& column) {
  const std::string_view header = column.header;
  return 1 + static_cast<std::size_t>(std::count(header.begin(), header.end(), ','));
}

}  // namespace haptic::exporting
