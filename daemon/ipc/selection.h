#pragma once
// Which part of a frame a subscription wants: by name, as the client said it, and by index, as snapshots have
// it. Names become indices anew in every scene; one that is not there selects nothing.

#include <cstdint>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "servo/mailbox.h"

namespace haptic::ipc {

/// By name. An empty list: all.
struct Filter {
  std::vector<std::string> fingers;  // ascending, each once
  std::vector<std::string> objects;  // likewise
  bool only_in_contact = false;

  bool operator==(const Filter&) const = default;
};

Filter filter_of(const v1::Subscribe& request);

/// By index, in the scene of one revision.
struct Selection {
  std::uint64_t revision = 0;
  bool all_hips = true;
  bool all_objects = true;
  bool only_in_contact = false;
  std::vector<bool> hips;     // unless all; those beyond its end are not selected
  std::vector<bool> objects;  // likewise

  bool has_hip(std::size_t i) const { return all_hips || (i < hips.size() && hips[i]); }
  bool has_object(std::size_t i) const { return all_objects || (i < objects.size() && objects[i]); }
};

Selection select(const Filter& filter, const v1::SceneDescription& scene);

/// Whether something acts on the HIP there: a surface holds it, or a material pushes. In free cells neither
/// does.
bool is_contact(const servo::ContactSnapshot& contact) noexcept;

}  // namespace haptic::ipc
