#include "proto/metrics/exposition.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "proto/metrics/names.h"

namespace haptic::metrics {

namespace {

constexpr double kNanosecondsPerSecond = 1e9;  // to divide by: 4095 / 1e9 is 4.095e-06, 4095 * 1e-9 is not

// Bins of the daemon's histograms end at these, so that no count is split: 2^n - 1 ns, from 1 us to 0.5 s.
constexpr int kFirstPower = 10;
constexpr int kLastPower = 29;

using Labels = std::initializer_list<std::pair<const char*, std::string>>;

// the shortest text that reads back as this number
std::string to_text(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "+Inf" : "-Inf";
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string escaped(const std::string& value) {
  std::string text;
  text.reserve(value.size());
  for (const char c : value) {
    if (c == '\\' || c == '"') text.push_back('\\');
    if (c == '\n') {
      text += "\\n";
    } else {
      text.push_back(c);
    }
  }
  return text;
}

std::string in_braces(const Labels& labels) {
  std::string text;
  for (const auto& [name, value] : labels) {
    text += (text.empty() ? "{" : ",") + std::string(name) + "=\"" + escaped(value) + "\"";
  }
  return text.empty() ? text : text + "}";
}

/// All samples of one name stand together, after what it means.
class Page {
 public:
  void begin(const std::string& name, const char* type, const char* help) {
    name_ = name;
    text_ += "# HELP " + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
  }

  // counts are told as whole numbers, whatever their size
  void add(std::uint64_t value, const Labels& labels = {}, const char* suffix = "") {
    line(std::to_string(value), labels, suffix);
  }
  void add(double value, const Labels& labels = {}, const char* suffix = "") {
    line(to_text(value), labels, suffix);
  }

  void gauge(const std::string& name, auto value, const char* help) {
    begin(name, "gauge", help);
    add(value);
  }
  void counter(const std::string& name, std::uint64_t value, const char* help) {
    begin(name, "counter", help);
    add(value);
  }

  void add(const v1::Histogram& histogram, const char* label = nullptr) {
    const std::string& value = histogram.name();
    const auto add_bucket = [&](const std::string& le, std::uint64_t below) {
      if (label == nullptr) {
        add(below, {{"le", le}}, "_bucket");
      } else {
        add(below, {{label, value}, {"le", le}}, "_bucket");
      }
    };
    std::uint64_t below = 0;
    int bin = 0;
    const int bins = std::min(histogram.upper_ns_size(), histogram.count_size());
    for (int power = kFirstPower; power <= kLastPower; ++power) {
      const std::uint64_t upper_ns = (std::uint64_t{1} << static_cast<unsigned>(power)) - 1;
      for (; bin < bins && histogram.upper_ns(bin) <= upper_ns; ++bin) below += histogram.count(bin);
      add_bucket(to_text(static_cast<double>(upper_ns) / kNanosecondsPerSecond), below);
    }
    add_bucket("+Inf", histogram.total());
    const double sum = histogram.mean_ns() * static_cast<double>(histogram.total()) / kNanosecondsPerSecond;
    if (label == nullptr) {
      add(sum, {}, "_sum");
      add(histogram.total(), {}, "_count");
    } else {
      add(sum, {{label, value}}, "_sum");
      add(histogram.total(), {{label, value}}, "_count");
    }
  }

  std::string take() { return std::move(text_); }

 private:
  void line(const std::string& value, const Labels& labels, const char* suffix) {
    text_ += name_ + suffix + in_braces(labels) + " " + value + "\n";
  }

  std::string name_;
  std::string text_;
};

std::uint64_t one_if(bool is_so) { return is_so ? 1 : 0; }

void add_status(const v1::Status& status, Page& page) {
  page.begin("hapticd_info", "gauge", "Always 1; what runs.");
  page.add(std::uint64_t{1}, {{"version", status.version()}, {"scene", status.scene()}});
  page.gauge("hapticd_uptime_seconds", status.uptime(), "Time since the daemon's start.");
  page.gauge("hapticd_rate_hertz", status.rate_hz(), "Rate of the servo thread.");
  page.counter("hapticd_ticks_total", status.tick(), "Servo periods since the start, missed ones included.");
  page.counter("hapticd_missed_ticks_total", status.missed_ticks(), "Servo periods that were slept through.");
  page.gauge("hapticd_armed", one_if(status.armed()), "1 if devices may push.");
  page.gauge("hapticd_paused", one_if(status.paused()), "1 if the scene stands still.");
  page.gauge("hapticd_clients", std::uint64_t{status.clients()}, "Clients that are connected.");
  page.gauge("hapticd_objects", std::uint64_t{status.objects()}, "Objects in the scene.");
  page.gauge("hapticd_fingers", std::uint64_t{status.fingers()}, "Fingers in the scene.");
  page.gauge("hapticd_hips", std::uint64_t{status.hips()}, "Haptic interface points in the scene.");
  page.gauge("hapticd_scene_revision", status.scene_revision(), "Revision of the scene that runs.");
  page.gauge("hapticd_real_time_scheduling", one_if(status.real_time().fifo()),
             "1 if the servo thread has real-time priority.");
  page.gauge("hapticd_memory_locked", one_if(status.real_time().memory_locked()),
             "1 if no page of the daemon can be swapped out.");
  page.gauge("hapticd_drive_lease_held", one_if(status.has_drive_holder()),
             "1 if a client holds the drive lease.");
}

void add_faults(const Numbers& numbers, Page& page) {
  page.gauge("hapticd_faults_latched", static_cast<std::uint64_t>(numbers.status.fault_size()),
             "Faults that keep forces at zero until a person clears them.");
  if (!numbers.faults) return;
  page.begin("hapticd_faults_total", "counter", "Faults that have been latched.");
  for (int kind = v1::FAULT_NONE + 1; kind <= v1::FaultKind_MAX; ++kind) {
    const auto found = numbers.faults->find(static_cast<v1::FaultKind>(kind));
    page.add(found == numbers.faults->end() ? 0 : found->second,
             {{"kind", word_of(static_cast<v1::FaultKind>(kind))}});
  }
}

void add_devices(const v1::DeviceList& devices, Page& page) {
  std::map<v1::DevicePhase, std::uint64_t> phases;
  for (const v1::DeviceStatus& device : devices.device()) ++phases[device.phase()];
  page.begin("hapticd_devices", "gauge", "Devices in each phase of their life.");
  for (int phase = v1::DevicePhase_MIN; phase <= v1::DevicePhase_MAX; ++phase) {
    page.add(phases[static_cast<v1::DevicePhase>(phase)],
             {{"phase", word_of(static_cast<v1::DevicePhase>(phase))}});
  }
  const auto add_each = [&](const char* name, const char* type, const char* help, auto value_of) {
    if (devices.device().empty()) return;
    page.begin(name, type, help);
    for (const v1::DeviceStatus& device : devices.device()) {
      page.add(value_of(device),
               {{"device", device.description().name()}, {"driver", device.description().driver()}});
    }
  };
  add_each("hapticd_device_present", "gauge", "1 if there is a fresh sample.",
           [](const v1::DeviceStatus& device) { return one_if(device.present()); });
  add_each("hapticd_device_sample_age_seconds", "gauge", "Age of the newest sample.",
           [](const v1::DeviceStatus& device) { return device.sample_age(); });
  add_each("hapticd_device_force_newtons", "gauge", "Magnitude of the force that the guard let through.",
           [](const v1::DeviceStatus& device) {
             const v1::Vector3& f = device.wrench().force();
             return std::sqrt(f.x() * f.x() + f.y() * f.y() + f.z() * f.z());
           });
  add_each("hapticd_device_losses_total", "counter", "Times that the device was lost.",
           [](const v1::DeviceStatus& device) { return std::uint64_t{device.losses()}; });
}

std::string word_of_state(v1::ConstraintState state) {
  switch (state) {
    case v1::TET:
      return "tet";
    case v1::SUR:
      return "sur";
    case v1::EDG:
      return "edg";
    case v1::VER:
      return "ver";
    default:
      return "out";
  }
}

void add_stats(const v1::Stats& stats, Page& page) {
  page.counter("hapticd_lost_snapshots_total", stats.lost_snapshots(),
               "Ticks that were lost on their way to clients.");
  page.begin("hapticd_wakeup_lateness_seconds", "histogram", "Lateness of the servo thread.");
  page.add(stats.wakeup());
  page.begin("hapticd_stage_seconds", "histogram", "Time that each stage of a tick takes; tick: the whole.");
  for (const v1::Histogram& stage : stats.stage()) page.add(stage, "stage");
  page.begin("hapticd_transitions_total", "counter",
             "Transitions of the constraint of a HIP, since the scene began to run.");
  for (const v1::TransitionStats& transition : stats.transition()) {
    page.add(std::uint64_t{transition.count()},
             {{"from", word_of_state(transition.before())}, {"to", word_of_state(transition.after())}});
  }
  page.counter("hapticd_limited_hips_total", stats.limited_hips(),
               "HIPs that met the limit of transitions in a tick.");
  page.counter("hapticd_relocations_total", stats.relocations(),
               "HIPs that were put elsewhere out of a circle of transitions.");
}

}  // namespace

std::optional<std::map<v1::FaultKind, std::uint64_t>> count_faults(const v1::FaultList& faults, int most) {
  if (faults.fault_size() >= most) return std::nullopt;
  std::map<v1::FaultKind, std::uint64_t> counts;
  for (const v1::FaultList::FaultRecord& record : faults.fault()) ++counts[record.fault().kind()];
  return counts;
}

std::string exposition(const Numbers& numbers) {
  Page page;
  add_status(numbers.status, page);
  add_faults(numbers, page);
  add_devices(numbers.devices, page);
  add_stats(numbers.stats, page);
  return page.take();
}

}  // namespace haptic::metrics
