#pragma once
// Frames as tables: what `watch`, `objects`, `fingers` and `devices` show. Names come from the scene, since a
// frame has only numbers.

#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"

namespace haptic::cli {

/// What the indices of a frame mean.
struct Names {
  std::uint64_t scene_revision = 0;
  std::vector<std::string> objects;
  std::vector<v1::SceneDescription::FingerDescription> fingers;
  std::vector<std::string> devices;
};

Names names_of(const v1::SceneDescription& scene, const v1::DeviceList& devices);

/// What one finger feels.
struct FingerSummary {
  std::string name;
  std::string device;
  std::uint32_t hips = 0;
  std::uint32_t contacts = 0;         // HIPs that an object's material holds back
  std::uint32_t slipping = 0;         // of these
  double force[3] = {0.0, 0.0, 0.0};  // N, on the user
};

std::vector<FingerSummary> summarise_fingers(const Names& names, const v1::HipsFrame& hips);

/// Of item i of the frame.
std::string object_name(const Names& names, const v1::ObjectsFrame& objects, int i);

/// Each with a heading; "" where there is nothing to show.
std::string objects_table(const Names& names, const v1::ObjectsFrame& objects);
std::string devices_table(const Names& names, const v1::DevicesFrame& devices);
std::string fingers_table(const Names& names, const v1::HipsFrame& hips);
/// One row for each HIP that is in contact.
std::string hips_table(const Names& names, const v1::HipsFrame& hips);

}  // namespace haptic::cli
