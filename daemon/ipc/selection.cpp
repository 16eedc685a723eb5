#include "ipc/selection.h"

#include <algorithm>

namespace haptic::ipc {
namespace {

using Names = google::protobuf::RepeatedPtrField<std::string>;

std::vector<std::string> sorted(const Names& names) {
  std::vector<std::string> out(names.begin(), names.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::binary_search(names.begin(), names.end(), name);
}

}  // namespace

Filter filter_of(const v1::Subscribe& request) {
  return {sorted(request.finger()), sorted(request.object()), request.only_in_contact()};
}

Selection select(const Filter& filter, const v1::SceneDescription& scene) {
  Selection selection;
  selection.revision = scene.revision();
  selection.all_hips = filter.fingers.empty();
  selection.all_objects = filter.objects.empty();
  selection.only_in_contact = filter.only_in_contact;
  for (const auto& finger : scene.finger()) {
    const std::size_t end = std::size_t{finger.first_hip()} + finger.hips();
    if (has(filter.fingers, finger.name())) {
      selection.hips.resize(std::max(end, selection.hips.size()));
      std::fill(selection.hips.begin() + finger.first_hip(),
                selection.hips.begin() + static_cast<std::ptrdiff_t>(end), true);
    }
  }
  for (const auto& object : scene.object()) {
    selection.objects.push_back(has(filter.objects, object.name()));
  }
  return selection;
}

bool is_contact(const servo::ContactSnapshot& contact) noexcept {
  switch (contact.state) {
    case engine::ConstraintState::kSur:
    case engine::ConstraintState::kEdg:
    case engine::ConstraintState::kVer:
      return true;
    default:
      return contact.force != glm::dvec3{0.0};
  }
}

}  // namespace haptic::ipc
