#include "client/export/frame_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "proto/recording/error.h"

namespace haptic::exporting {
namespace {

using recording::FormatError;
using Numbers = google::protobuf::RepeatedField<double>;

constexpr std::size_t kVector = 3;
constexpr std::size_t kQuaternion = 4;

// rows of so many numbers each
std::size_t rows_of(const v1::Frame& frame, const Numbers& numbers, std::size_t width) {
  const auto size = static_cast<std::size_t>(numbers.size());
  if (size % width != 0) {
    throw FormatError(fmt::format("the frame of tick {} has a list of {} numbers, which is no multiple of {}",
                                  frame.tick(), size, width));
  }
  return size / width;
}

void expect_rows(const v1::Frame& frame, std::size_t rows, std::initializer_list<std::size_t> lists) {
  for (const std::size_t list : lists) {
    if (list != rows) {
      throw FormatError(
          fmt::format("the frame of tick {} has lists of {} and of {} items for the same things",
                      frame.tick(), rows, list));
    }
  }
}

std::size_t size_of(const auto& list) { return static_cast<std::size_t>(list.size()); }

template <std::size_t kWidth>
void add_components(TableWriter& table, const Numbers& numbers, std::size_t row) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    table.add(numbers[static_cast<int>(kWidth * row + i)]);
  }
}

void add_zeros(TableWriter& table) {
  for (std::size_t i = 0; i < kVector; ++i) {
    table.add(0.0);
  }
}

void begin_row(TableWriter& table, const v1::Frame& frame, const Naming& naming) {
  table.add(std::uint64_t{frame.tick()});
  table.add(static_cast<double>(frame.tick()) / naming.rate_hz);
}

std::string unnamed(std::size_t index) { return "#" + std::to_string(index); }

const v1::SceneDescription* scene_of(const v1::Frame& frame, const Naming& naming) {
  const auto found = naming.scenes.find(frame.scene_revision());
  return found == naming.scenes.end() ? nullptr : &found->second;
}

std::string object_name(const v1::SceneDescription* scene, std::size_t index) {
  return scene != nullptr && index < size_of(scene->object()) ? scene->object(static_cast<int>(index)).name()
                                                              : unnamed(index);
}

// the finger that a HIP of the scene belongs to, and its place there
struct HipName {
  std::string finger;
  std::uint64_t hip = 0;
};

HipName hip_name(const v1::SceneDescription* scene, std::size_t index) {
  if (scene != nullptr) {
    for (const auto& finger : scene->finger()) {
      if (index >= finger.first_hip() && index - finger.first_hip() < finger.hips()) {
        return {finger.name(), index - finger.first_hip()};
      }
    }
  }
  return {unnamed(index), 0};
}

std::string_view name_of(v1::ConstraintState state) {
  constexpr std::array<std::string_view, 5> kNames = {"Tet", "Sur", "Edg", "Ver", "Out"};
  return v1::ConstraintState_IsValid(state) ? kNames.at(static_cast<std::size_t>(state)) : kNames.front();
}

// as simulate writes it: "over_speed"; empty for none
std::string name_of(v1::FaultKind kind) {
  if (kind == v1::FAULT_NONE || !v1::FaultKind_IsValid(kind)) {
    return "";
  }
  std::string name = v1::FaultKind_Name(kind).substr(std::string_view("FAULT_").size());
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name;
}

std::string name_of(v1::Event::Kind kind) {
  std::string name = v1::Event::Kind_IsValid(kind) ? v1::Event::Kind_Name(kind) : "";
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name;
}

// the contacts of each HIP of the frame, in the order of objects
class ContactsOfHips {
 public:
  ContactsOfHips(const v1::Frame& frame, std::size_t rows) : order_(size_of(frame.hips().contact_hip())) {
    const v1::HipsFrame& hips = frame.hips();
    const std::size_t contacts = order_.size();
    expect_rows(
        frame, contacts,
        {size_of(hips.contact_object()), size_of(hips.contact_state()), size_of(hips.contact_slipping()),
         rows_of(frame, hips.contact_proxy(), kVector), rows_of(frame, hips.contact_force(), kVector)});
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    const auto key = [&hips](std::size_t contact) {
      const int i = static_cast<int>(contact);
      return std::pair(hips.contact_hip(i), hips.contact_object(i));
    };
    std::sort(order_.begin(), order_.end(),
              [&key](std::size_t left, std::size_t right) { return key(left) < key(right); });
    // a HIP's place among all is its row, unless the subscription selected
    for (std::size_t row = 0; row < rows; ++row) {
      index_.push_back(hips.hip().empty() ? static_cast<std::uint32_t>(row)
                                          : hips.hip(static_cast<int>(row)));
    }
  }

  std::uint32_t index_of(std::size_t row) const { return index_[row]; }

  /// Calls `use` with each contact of the HIP in this row; returns how many.
  std::size_t for_each(const v1::HipsFrame& hips, std::size_t row, const auto& use) const {
    const auto hip_of = [&hips](std::size_t contact) { return hips.contact_hip(static_cast<int>(contact)); };
    const auto first = std::partition_point(
        order_.begin(), order_.end(), [&](std::size_t contact) { return hip_of(contact) < index_[row]; });
    auto at = first;
    for (; at != order_.end() && hip_of(*at) == index_[row]; ++at) {
      use(*at);
    }
    return static_cast<std::size_t>(at - first);
  }

 private:
  std::vector<std::size_t> order_;
  std::vector<std::uint32_t> index_;
};

void add_hips(const v1::Frame& frame, const Naming& naming, bool with_free, TableWriter& table) {
  const v1::HipsFrame& hips = frame.hips();
  const std::size_t rows = rows_of(frame, hips.position(), kVector);
  expect_rows(frame, rows,
              {rows_of(frame, hips.force(), kVector), hips.hip().empty() ? rows : size_of(hips.hip())});
  const ContactsOfHips contacts(frame, rows);
  const v1::SceneDescription* const scene = scene_of(frame, naming);
  for (std::size_t row = 0; row < rows; ++row) {
    const HipName name = hip_name(scene, contacts.index_of(row));
    const auto begin = [&](std::string_view object, std::string_view state, bool slipping) {
      begin_row(table, frame, naming);
      table.add(std::string_view(name.finger));
      table.add(name.hip);
      table.add(object);
      table.add(state);
      table.add(slipping);
      if (with_free) {
        add_components<kVector>(table, hips.position(), row);
      }
    };
    const std::size_t held = contacts.for_each(hips, row, [&](std::size_t contact) {
      const int i = static_cast<int>(contact);
      begin(object_name(scene, hips.contact_object(i)), name_of(hips.contact_state(i)),
            hips.contact_slipping(i));
      add_components<kVector>(table, hips.contact_proxy(), contact);
      add_components<kVector>(table, hips.contact_force(), contact);
      table.end_row();
    });
    if (held == 0 && with_free) {
      begin("", name_of(v1::OUT), false);
      add_components<kVector>(table, hips.position(), row);
      add_zeros(table);
      table.end_row();
    }
  }
}

void add_objects(const v1::Frame& frame, const Naming& naming, TableWriter& table) {
  const v1::ObjectsFrame& objects = frame.objects();
  const std::size_t rows = rows_of(frame, objects.position(), kVector);
  expect_rows(
      frame, rows,
      {rows_of(frame, objects.orientation(), kQuaternion), rows_of(frame, objects.velocity(), kVector),
       rows_of(frame, objects.angular_velocity(), kVector), rows_of(frame, objects.force(), kVector),
       rows_of(frame, objects.torque(), kVector),
       objects.object().empty() ? rows : size_of(objects.object())});
  const v1::SceneDescription* const scene = scene_of(frame, naming);
  for (std::size_t row = 0; row < rows; ++row) {
    begin_row(table, frame, naming);
    const std::size_t index = objects.object().empty() ? row : objects.object(static_cast<int>(row));
    table.add(std::string_view(object_name(scene, index)));
    add_components<kVector>(table, objects.position(), row);
    add_components<kQuaternion>(table, objects.orientation(), row);
    add_components<kVector>(table, objects.velocity(), row);
    add_components<kVector>(table, objects.angular_velocity(), row);
    add_components<kVector>(table, objects.force(), row);
    add_components<kVector>(table, objects.torque(), row);
    table.end_row();
  }
}

void add_devices(const v1::Frame& frame, const Naming& naming, TableWriter& table) {
  const v1::DevicesFrame& devices = frame.devices();
  const std::size_t rows = rows_of(frame, devices.position(), kVector);
  expect_rows(frame, rows,
              {rows_of(frame, devices.orientation(), kQuaternion),
               rows_of(frame, devices.velocity(), kVector), rows_of(frame, devices.force(), kVector),
               rows_of(frame, devices.torque(), kVector), size_of(devices.sample_age()),
               size_of(devices.buttons()), size_of(devices.present()), size_of(devices.fault())});
  for (std::size_t row = 0; row < rows; ++row) {
    const int i = static_cast<int>(row);
    begin_row(table, frame, naming);
    table.add(std::string_view(row < naming.devices.size() ? naming.devices[row] : unnamed(row)));
    add_components<kVector>(table, devices.position(), row);
    add_components<kQuaternion>(table, devices.orientation(), row);
    add_components<kVector>(table, devices.force(), row);
    add_components<kVector>(table, devices.torque(), row);
    table.add(frame.armed());
    table.add(std::string_view(name_of(devices.fault(i))));
    add_components<kVector>(table, devices.velocity(), row);
    table.add(devices.sample_age(i));
    table.add(std::uint64_t{devices.buttons(i)});
    table.add(devices.present(i));
    table.end_row();
  }
}

void add_event(const v1::Frame& frame, const Naming& naming, TableWriter& table) {
  const v1::Event& event = frame.event();
  begin_row(table, frame, naming);
  table.add(std::string_view(name_of(event.kind())));
  table.add(std::string_view(name_of(event.fault().kind())));
  table.add(std::string_view(event.fault().device()));
  table.add(std::uint64_t{event.scene_revision()});
  table.add(std::string_view(event.message()));
  table.end_row();
}

void add_stats(const v1::Frame& frame, const Naming& naming, TableWriter& table) {
  const v1::Stats& stats = frame.stats();
  const auto add = [&](std::string_view stage, const v1::Histogram& histogram) {
    begin_row(table, frame, naming);
    table.add(std::uint64_t{stats.missed_ticks()});
    table.add(std::uint64_t{stats.lost_snapshots()});
    table.add(stage);
    table.add(std::uint64_t{histogram.total()});
    table.add(histogram.mean_ns());
    for (const std::uint64_t ns :
         {histogram.p50_ns(), histogram.p99_ns(), histogram.p999_ns(), histogram.max_ns()}) {
      table.add(std::uint64_t{ns});
    }
    table.end_row();
  };
  add("wake-up", stats.wakeup());
  for (const v1::Histogram& stage : stats.stage()) {
    add(stage.name(), stage);
  }
}

}  // namespace

void add_rows(Topic topic, const v1::Frame& frame, const Naming& naming, TableWriter& table) {
  switch (topic) {
    case Topic::kHips:
    case Topic::kContacts:
      if (frame.has_hips()) add_hips(frame, naming, topic == Topic::kHips, table);
      break;
    case Topic::kObjects:
      if (frame.has_objects()) add_objects(frame, naming, table);
      break;
    case Topic::kDevices:
      if (frame.has_devices()) add_devices(frame, naming, table);
      break;
    case Topic::kEvents:
      if (frame.has_event()) add_event(frame, naming, table);
      break;
    case Topic::kStats:
      if (frame.has_stats()) add_stats(frame, naming, table);
      break;
    case Topic::kGaps:  // these are no frames
      break;
  }
}

void add_row(const v1::Gap& gap, TableWriter& table) {
  table.add(std::uint64_t{gap.first_tick()});
  table.add(std::uint64_t{gap.last_tick()});
  table.add(std::uint64_t{gap.last_sequence() - gap.first_sequence() + 1});
  table.end_row();
}

}  // namespace haptic::exporting
