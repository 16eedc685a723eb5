#include "client/cli/tables.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "client/cli/describe.h"
#include "client/cli/table.h"

namespace haptic::cli {
namespace {

// item i of a packed array of triples; zero where the frame is shorter
struct Triple {
  double x = 0.0, y = 0.0, z = 0.0;
  double length() const { return std::sqrt(x * x + y * y + z * z); }
};

template <class Array>
Triple triple(const Array& values, int i) {
  if (3 * i + 2 >= values.size()) {
    return {};
  }
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

template <class Array>
auto item(const Array& values, int i) {
  return i < values.size() ? values[i] : typename Array::value_type{};
}

// which one item i is about: a frame that shows a part only has their numbers
template <class Numbers>
std::uint32_t number_of(const Numbers& numbers, int i) {
  return numbers.empty() ? static_cast<std::uint32_t>(i) : item(numbers, i);
}

std::string name_at(const std::vector<std::string>& names, std::size_t i) {
  return i < names.size() ? names[i] : fmt::format("#{}", i);
}

// wide enough that columns stand still while their numbers change
std::string coordinate(double metres) { return fmt::format("{:>8}", millimetres(metres)); }
std::string millimetres_per_second(double speed) { return fmt::format("{:>6.1f}", speed * 1e3); }
// no negative zero
double rounded(double value, double unit) { return std::round(value / unit) * unit + 0.0; }
std::string newtons(double force) { return fmt::format("{:.3f}", force); }
std::string signed_newtons(double force) { return fmt::format("{:>+7.3f}", rounded(force, 1e-3)); }

// what the quaternion turns by, and about what
std::string turn(const google::protobuf::RepeatedField<double>& values, int i) {
  if (4 * i + 3 >= values.size()) {
    return "-";
  }
  const Triple axis{values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
  const double sine = axis.length();
  const double angle = 2.0 * std::atan2(sine, std::abs(values[4 * i])) * 180.0 / M_PI;
  if (angle < 0.05) {
    return "0.0";
  }
  // -q is the same rotation as q
  const double scale = (values[4 * i] < 0.0 ? -1.0 : 1.0) / sine;
  return fmt::format("{:.1f} about {:+.2f} {:+.2f} {:+.2f}", angle, rounded(scale * axis.x, 0.01),
                     rounded(scale * axis.y, 0.01), rounded(scale * axis.z, 0.01));
}

// whether material acts on the HIP there; in free cells it is held by nothing but the cell itself
bool is_contact(const v1::HipsFrame& hips, int i) {
  const auto state = hips.contact_state(i);
  return state == v1::SUR || state == v1::EDG || state == v1::VER ||
         triple(hips.contact_force(), i).length() > 0.0;
}

}  // namespace

Names names_of(const v1::SceneDescription& scene, const v1::DeviceList& devices) {
  Names names;
  names.scene_revision = scene.revision();
  for (const auto& object : scene.object()) {
    names.objects.push_back(object.name());
  }
  names.fingers.assign(scene.finger().begin(), scene.finger().end());
  for (const auto& device : devices.device()) {
    names.devices.push_back(device.description().name());
  }
  return names;
}

std::vector<FingerSummary> summarise_fingers(const Names& names, const v1::HipsFrame& hips) {
  std::map<std::uint32_t, bool> slips;  // by HIP in contact
  for (int i = 0; i < hips.contact_state_size(); ++i) {
    if (is_contact(hips, i)) {
      bool& slip = slips[item(hips.contact_hip(), i)];
      slip = slip || item(hips.contact_slipping(), i);
    }
  }
  std::vector<FingerSummary> summaries;
  for (const auto& finger : names.fingers) {
    FingerSummary& summary = summaries.emplace_back();
    summary.name = finger.name();
    summary.device = finger.device();
    summary.hips = finger.hips();
    for (int i = 0; i < hips.position_size() / 3; ++i) {
      const std::uint32_t hip = number_of(hips.hip(), i);
      if (hip < finger.first_hip() || hip - finger.first_hip() >= finger.hips()) {
        continue;
      }
      const auto contact = slips.find(hip);
      summary.contacts += contact != slips.end() ? 1U : 0U;
      summary.slipping += contact != slips.end() && contact->second ? 1U : 0U;
      const Triple force = triple(hips.force(), i);
      summary.force[0] += force.x;
      summary.force[1] += force.y;
      summary.force[2] += force.z;
    }
  }
  return summaries;
}

std::string object_name(const Names& names, const v1::ObjectsFrame& objects, int i) {
  return name_at(names.objects, number_of(objects.object(), i));
}

std::string objects_table(const Names& names, const v1::ObjectsFrame& objects) {
  Table table({{"object", Align::kLeft},
               {"x mm"},
               {"y mm"},
               {"z mm"},
               {"speed mm/s"},
               {"by fingers N"},
               {"turn deg", Align::kLeft}});
  for (int i = 0; i < objects.position_size() / 3; ++i) {
    const Triple at = triple(objects.position(), i);
    table.add({object_name(names, objects, i), coordinate(at.x), coordinate(at.y), coordinate(at.z),
               millimetres_per_second(triple(objects.velocity(), i).length()),
               newtons(triple(objects.force(), i).length()), turn(objects.orientation(), i)});
  }
  return table.empty() ? "" : table.to_string();
}

std::string devices_table(const Names& names, const v1::DevicesFrame& devices) {
  Table table({{"device", Align::kLeft},
               {"x mm"},
               {"y mm"},
               {"z mm"},
               {"speed mm/s"},
               {"force N"},
               {"age ms"},
               {"buttons"},
               {"state", Align::kLeft}});
  for (int i = 0; i < devices.present_size(); ++i) {
    const Triple at = triple(devices.position(), i);
    const auto fault = static_cast<v1::FaultKind>(item(devices.fault(), i));
    std::string state = devices.present(i) ? "present" : "absent";
    if (fault != v1::FAULT_NONE) {
      state = "FAULT " + describe(fault);
    }
    table.add({name_at(names.devices, static_cast<std::size_t>(i)), coordinate(at.x), coordinate(at.y),
               coordinate(at.z), millimetres_per_second(triple(devices.velocity(), i).length()),
               newtons(triple(devices.force(), i).length()),
               fmt::format("{:.1f}", item(devices.sample_age(), i) * 1e3),
               fmt::format("{:b}", item(devices.buttons(), i)), state});
  }
  return table.empty() ? "" : table.to_string();
}

std::string fingers_table(const Names& names, const v1::HipsFrame& hips) {
  Table table({{"finger", Align::kLeft},
               {"device", Align::kLeft},
               {"HIPs"},
               {"in contact"},
               {"slipping"},
               {"force N"},
               {"x N"},
               {"y N"},
               {"z N"}});
  for (const FingerSummary& finger : summarise_fingers(names, hips)) {
    const Triple force{finger.force[0], finger.force[1], finger.force[2]};
    table.add({finger.name, finger.device, fmt::format("{}", finger.hips), fmt::format("{}", finger.contacts),
               fmt::format("{}", finger.slipping), newtons(force.length()), signed_newtons(force.x),
               signed_newtons(force.y), signed_newtons(force.z)});
  }
  return table.empty() ? "" : table.to_string();
}

std::string hips_table(const Names& names, const v1::HipsFrame& hips) {
  Table table({{"HIP"},
               {"finger", Align::kLeft},
               {"object", Align::kLeft},
               {"state", Align::kLeft},
               {"slips", Align::kLeft},
               {"proxy x mm"},
               {"y mm"},
               {"z mm"},
               {"force N"}});
  for (int i = 0; i < hips.contact_state_size(); ++i) {
    if (!is_contact(hips, i)) {
      continue;
    }
    const std::uint32_t hip = item(hips.contact_hip(), i);
    std::string finger_name = "-";
    for (const auto& finger : names.fingers) {
      if (hip >= finger.first_hip() && hip - finger.first_hip() < finger.hips()) {
        finger_name = finger.name();
      }
    }
    const Triple proxy = triple(hips.contact_proxy(), i);
    table.add({fmt::format("{}", hip), finger_name, name_at(names.objects, item(hips.contact_object(), i)),
               name_of(hips.contact_state(i)), item(hips.contact_slipping(), i) ? "slips" : "",
               coordinate(proxy.x), coordinate(proxy.y), coordinate(proxy.z),
               newtons(triple(hips.contact_force(), i).length())});
  }
  return table.empty() ? "" : table.to_string();
}

}  // namespace haptic::cli
