#include "load/check.h"

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <optional>
#include <ostream>
#include <utility>

#include "load/device_config.h"
#include "load/error.h"
#include "load/ranges.h"
#include "load/scene_report.h"

namespace haptic::load {
namespace {

using google::protobuf::Struct;
using google::protobuf::Value;

constexpr int kGood = 0;
constexpr int kBad = 1;
constexpr int kUsage = 64;

/// What was understood of both files; each part may be missing.
struct Report {
  std::optional<LoadedConfig> config;
  std::optional<SceneReport> scene;
};

Report make_report(const CheckOptions& options) {
  Report report;
  std::string scene = options.scene;
  if (!options.config.empty()) {
    report.config = load_config(options.config);
    if (scene.empty()) scene = report.config->message.scene();
  }
  if (scene.empty()) return report;
  const auto loaded =
      load_scene(scene, report.config ? report.config->message.capacity() : default_capacity());
  report.scene = report_scene(*loaded, report.config ? &*report.config : nullptr);
  return report;
}

// each at its place in the config
std::vector<LoadError> tls_errors(const Report& report, const CheckOptions& options) {
  std::vector<LoadError> errors;
  if (!report.config || !options.tls_problems) return errors;
  const auto& listen = report.config->message.listen();
  for (int i = 0; i < listen.size(); ++i) {
    if (!listen[i].tcp().has_tls()) continue;
    for (const TlsProblem& problem : options.tls_problems(listen[i].tcp().tls())) {
      const std::string field = item("listen", i) + ".tcp.tls." + problem.field;
      Place place = report.config->source.find(field);
      place.field = field;
      errors.emplace_back(std::move(place), problem.message);
    }
  }
  return errors;
}

std::string address_of(const v1::Listen& listen) {
  if (listen.has_unix()) return listen.unix().path();
  const bool is_six = listen.tcp().address().find(':') != std::string::npos;
  return (is_six ? "[" + listen.tcp().address() + "]" : listen.tcp().address()) + ":" +
         std::to_string(listen.tcp().port());
}

double bytes_per_cell(const ObjectReport& object) {
  return static_cast<double>(object.bytes) / static_cast<double>(object.cells);
}

// ---- text ----

void print(const LoadedConfig& config, std::ostream& out) {
  const v1::DaemonConfig& message = config.message;
  out << "config " << config.source.file() << "\n";
  out << "  servo      " << to_text(message.servo().rate_hz()) << " Hz, priority "
      << message.servo().priority()
      << (message.servo().has_cpu() ? ", core " + std::to_string(message.servo().cpu()) : "")
      << (message.servo().lock_memory() ? ", memory locked" : "") << "\n";
  out << "  safety     force up to " << to_text(message.safety().max_force()) << " N, "
      << to_text(message.safety().max_force_rate()) << " N/s; speed up to "
      << to_text(message.safety().max_speed()) << " m/s\n";
  for (int i = 0; i < message.device_size(); ++i) {
    const auto& path = config.paths[static_cast<std::size_t>(i)];
    out << "  device     " << message.device(i).name() << ": " << driver_name(message.device(i));
    if (!path.empty()) {
      out << ", path of " << path.size() << " rows to " << to_text(path.back().time) << " s";
    }
    const std::string& firmware = config.firmware[static_cast<std::size_t>(i)];
    if (!firmware.empty()) {
      out << ", firmware of " << firmware.size() << " bytes, SHA-256 " << sha256(firmware);
    }
    out << "\n";
  }
  for (const v1::Listen& listen : message.listen()) out << "  listen     " << address_of(listen) << "\n";
}

void print(const ObjectReport& object, std::ostream& out) {
  out << "  object     " << object.name << ": ";
  if (object.dynamic) {
    out << "moves, " << to_text(object.mass) << " kg, inertia " << to_text(object.inertia.x) << " "
        << to_text(object.inertia.y) << " " << to_text(object.inertia.z) << " kg m^2";
    if (object.release_after > 0.0) out << ", released after " << to_text(object.release_after) << " s";
  } else {
    out << "fixed";
  }
  out << "\n             " << object.cells << " cells, " << object.vertices << " vertices, " << object.edges
      << " edges, " << object.faces << " faces, " << object.surface_triangles << " surface triangles\n"
      << "             " << object.bytes << " bytes, " << static_cast<std::uint64_t>(bytes_per_cell(object))
      << " per cell; at most " << object.most_cells_at_edge << " cells at an edge, "
      << object.most_cells_at_vertex << " at a vertex\n";
}

void print(const SceneReport& scene, std::ostream& out) {
  out << "scene " << scene.name << "\n";
  for (const std::string& material : scene.materials) out << "  material   " << material << "\n";
  for (const ObjectReport& object : scene.objects) print(object, out);
  for (const FingerReport& finger : scene.fingers) {
    out << "  finger     " << finger.name << " on device " << finger.device << ": " << finger.hips
        << (finger.hips == 1 ? " HIP" : " HIPs") << " of " << to_text(finger.stiffness) << " N/m\n";
  }
  for (const std::string& warning : scene.warnings) out << "  warning    " << warning << "\n";
}

// ---- JSON ----

Value value_of(const std::string& text) {
  Value value;
  value.set_string_value(text);
  return value;
}

Value value_of(double number) {
  Value value;
  value.set_number_value(number);
  return value;
}

Value value_of(std::size_t count) { return value_of(static_cast<double>(count)); }

Value value_of(bool flag) {
  Value value;
  value.set_bool_value(flag);
  return value;
}

Value value_of(Struct object) {
  Value value;
  *value.mutable_struct_value() = std::move(object);
  return value;
}

template <class Items, class Convert>
Value list_of(const Items& items, Convert convert) {
  Value value;
  value.mutable_list_value();
  for (const auto& item : items) *value.mutable_list_value()->add_values() = value_of(convert(item));
  return value;
}

Value json_of(const ObjectReport& object) {
  Struct json;
  auto& fields = *json.mutable_fields();
  fields["name"] = value_of(object.name);
  fields["dynamic"] = value_of(object.dynamic);
  fields["release_after"] = value_of(object.release_after);
  fields["cells"] = value_of(object.cells);
  fields["vertices"] = value_of(object.vertices);
  fields["edges"] = value_of(object.edges);
  fields["faces"] = value_of(object.faces);
  fields["surface_triangles"] = value_of(object.surface_triangles);
  fields["bytes"] = value_of(object.bytes);
  fields["bytes_per_cell"] = value_of(bytes_per_cell(object));
  fields["most_cells_at_edge"] = value_of(object.most_cells_at_edge);
  fields["most_cells_at_vertex"] = value_of(object.most_cells_at_vertex);
  fields["mass"] = value_of(object.mass);
  const double inertia[] = {object.inertia.x, object.inertia.y, object.inertia.z};
  fields["inertia"] = list_of(inertia, [](double moment) { return moment; });
  return value_of(std::move(json));
}

Value json_of(const FingerReport& finger) {
  Struct json;
  auto& fields = *json.mutable_fields();
  fields["name"] = value_of(finger.name);
  fields["device"] = value_of(finger.device);
  fields["hips"] = value_of(finger.hips);
  fields["stiffness"] = value_of(finger.stiffness);
  return value_of(std::move(json));
}

Value json_of(const SceneReport& scene) {
  Struct json;
  auto& fields = *json.mutable_fields();
  fields["name"] = value_of(scene.name);
  fields["hips"] = value_of(scene.hips);
  fields["materials"] = list_of(scene.materials, [](const std::string& name) { return name; });
  fields["objects"] = list_of(scene.objects, [](const ObjectReport& o) { return json_of(o).struct_value(); });
  fields["fingers"] = list_of(scene.fingers, [](const FingerReport& f) { return json_of(f).struct_value(); });
  return value_of(std::move(json));
}

Value json_of(const LoadedConfig& config) {
  Struct json;
  auto& fields = *json.mutable_fields();
  fields["file"] = value_of(config.source.file());
  fields["rate_hz"] = value_of(config.message.servo().rate_hz());
  fields["devices"] = list_of(config.message.device(), [](const v1::Device& device) {
    Struct one;
    (*one.mutable_fields())["name"] = value_of(device.name());
    (*one.mutable_fields())["driver"] = value_of(driver_name(device));
    return one;
  });
  fields["listen"] = list_of(config.message.listen(), address_of);
  return value_of(std::move(json));
}

Value json_of(const LoadError& error) {
  Struct json;
  auto& fields = *json.mutable_fields();
  fields["message"] = value_of(error.message());
  fields["file"] = value_of(error.file());
  fields["line"] = value_of(std::size_t{error.line()});
  fields["column"] = value_of(std::size_t{error.column()});
  fields["field"] = value_of(error.field());
  return value_of(std::move(json));
}

void print_json(const Struct& json, std::ostream& out) {
  std::string text;
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  // a Struct of finite numbers and UTF-8 text always prints
  (void)google::protobuf::util::MessageToJsonString(json, &text, options);
  out << text;
}

void print_json(const Report& report, std::ostream& out) {
  Struct json;
  auto& fields = *json.mutable_fields();
  if (report.config) fields["config"] = json_of(*report.config);
  if (report.scene) fields["scene"] = json_of(*report.scene);
  const std::vector<std::string> none;
  fields["warnings"] = list_of(report.scene ? report.scene->warnings : none,
                               [](const std::string& warning) { return warning; });
  print_json(json, out);
}

}  // namespace

int check(const CheckOptions& options, std::ostream& out, std::ostream& err) {
  if (options.config.empty() && options.scene.empty()) {
    err << "hapticd check: name a config, a scene or both\n";
    return kUsage;
  }
  std::vector<LoadError> errors;
  try {
    const Report report = make_report(options);
    errors = tls_errors(report, options);
    if (errors.empty() && options.json) {
      print_json(report, out);
    } else if (errors.empty()) {
      if (report.config) print(*report.config, out);
      if (report.scene) print(*report.scene, out);
    }
  } catch (const LoadError& error) {
    errors.push_back(error);
  }
  if (errors.empty()) return kGood;
  for (const LoadError& error : errors) err << "hapticd check: " << error.what() << "\n";
  if (options.json) {
    Struct json;
    (*json.mutable_fields())["error"] = json_of(errors.front());
    (*json.mutable_fields())["errors"] =
        list_of(errors, [](const LoadError& e) { return json_of(e).struct_value(); });
    print_json(json, out);
  }
  return kBad;
}

}  // namespace haptic::load
