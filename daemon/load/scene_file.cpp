#include "load/scene_file.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "engine/shapes.h"
#include "load/ranges.h"
#include "load/scene_parts.h"

namespace haptic::load {
namespace {

constexpr Range kAccelerations{-1e4, 1e4, " m/s^2"};
constexpr Range kViscosities{0.0, 1e6, " N s/m"};
constexpr Range kAngularViscosities{0.0, 1e6, " N m s/rad"};
constexpr Range kTimes{0.0, 1e9, " s"};

class SceneBuilder {
 public:
  SceneBuilder(LoadedScene& loaded, const TextSource& source, const std::filesystem::path* file,
               const v1::Capacity& capacity, const Built* running)
      : message_(loaded.message),
        scene_(loaded.scene),
        warnings_(loaded.warnings),
        source_(source),
        file_(file),
        capacity_(capacity),
        running_(running) {
    if (running == nullptr) return;
    for (int i = 0; i < running->message.object_size(); ++i) {
      running_cells_[key_of(running->message.object(i))] =
          running->scene.objects[static_cast<std::size_t>(i)].cells;
    }
  }

  void build() {
    check_values(message_, source_);
    scene_.name = message_.name();
    gravity();
    for (int i = 0; i < message_.material_size(); ++i) {
      material_names_.add(message_.material(i).name(), i);
      materials_.push_back(make_material(source_, item("material", i), message_.material(i)));
    }
    check_count("object", message_.object_size(), capacity_.objects());
    for (int i = 0; i < message_.object_size(); ++i) object(i);
    check_count("finger", message_.finger_size(), capacity_.fingers());
    for (int i = 0; i < message_.finger_size(); ++i) finger(i);
    engine::number_hips(scene_);
  }

 private:
  void gravity() {
    const v1::Vector3& gravity = message_.gravity();
    check_range(source_, "gravity.x", gravity.x(), kAccelerations);
    check_range(source_, "gravity.y", gravity.y(), kAccelerations);
    check_range(source_, "gravity.z", gravity.z(), kAccelerations);
    scene_.gravity = {gravity.x(), gravity.y(), gravity.z()};
  }

  void check_count(const std::string& list, int count, std::uint32_t most) const {
    if (static_cast<std::uint32_t>(count) <= most) return;
    source_.fail(item(list, static_cast<int>(most)), "is beyond the daemon's capacity (permitted: up to " +
                                                         std::to_string(most) + " " + list + "s)");
  }

  void object(int index) {
    const v1::Object& message = message_.object(index);
    const std::string field = item("object", index);
    object_names_.add(message.name(), index);
    engine::Object object;
    object.name = message.name();
    object.initial_pose = make_pose(source_, field + ".pose", message.pose());
    if (message.shape().has_mesh()) {
      check_mesh_object(field, message);
    } else {
      check_generated_object(field, message);
    }
    object.cells = cells(field, message);
    object.materials = message.shape().has_mesh() ? mesh_materials(field, message, *object.cells)
                                                  : generated_materials(message, *object.cells);
    if (message.has_dynamic()) dynamics(field + ".dynamic", message.dynamic(), object);
    scene_.objects.push_back(std::move(object));
  }

  // a mesh names its materials by region, anything else by inside and outside
  void check_mesh_object(const std::string& field, const v1::Object& message) const {
    if (!message.inside().empty()) source_.fail(field + ".inside", kMeshOnly);
    if (!message.outside().empty()) source_.fail(field + ".outside", kMeshOnly);
    if (message.air_margin() != 0.0) {
      source_.fail(field + ".air_margin", "a mesh brings its own cells around it (permitted: 0)");
    }
    std::set<std::int32_t> tags;
    for (int i = 0; i < message.region_size(); ++i) {
      const std::string region = field + "." + item("region", i);
      if (!tags.insert(message.region(i).tag()).second) {
        source_.fail(region + ".tag", "region " + std::to_string(message.region(i).tag()) + " is told twice");
      }
      material_names_.find(region + ".material", message.region(i).material());
    }
  }

  void check_generated_object(const std::string& field, const v1::Object& message) const {
    if (message.region_size() != 0) {
      source_.fail(field + ".region[0]", "only meshes have regions: name inside and outside instead");
    }
    if (message.shape().kind_case() == v1::Shape::KIND_NOT_SET) return;  // make_cells tells what is missing
    check_range(source_, field + ".air_margin", message.air_margin(), {0.0, kLargestLength, " m"});
    if (message.air_margin() != 0.0)
      check_range(source_, field + ".air_margin", message.air_margin(), kSizes);
    if (message.inside().empty())
      source_.fail(field + ".inside", "is missing: expected the name of a material");
    material_names_.find(field + ".inside", message.inside());
    if (message.air_margin() > 0.0 && message.outside().empty()) {
      source_.fail(field + ".outside",
                   "is missing: expected the material of the layer that air_margin asks for");
    }
    if (message.outside().empty()) return;
    material_names_.find(field + ".outside", message.outside());
    if (message.air_margin() == 0.0) {
      warnings_.push_back(field + ".outside: is not used, because air_margin is 0");
    }
  }

  using CellsKey = std::pair<std::string, double>;

  static CellsKey key_of(const v1::Object& object) {
    return {object.shape().SerializeAsString(), object.air_margin()};
  }

  // objects of the same shape share their cells, with those that run too
  std::shared_ptr<const engine::CellComplex> cells(const std::string& field, const v1::Object& message) {
    const CellsKey key = key_of(message);
    auto& cells = shared_cells_[key];
    if (cells == nullptr) {
      const auto same = running_cells_.find(key);
      cells = same != running_cells_.end()
                  ? same->second
                  : std::make_shared<const engine::CellComplex>(make_cells(
                        source_, field + ".shape", message.shape(), message.air_margin(), file_, warnings_));
      cell_count_ += cells->cells().size();
      if (cell_count_ > kMostCells) {
        source_.fail(field + ".shape", "brings the scene to " + std::to_string(cell_count_) +
                                           " cells (permitted: up to " + std::to_string(kMostCells) + ")");
      }
    }
    return cells;
  }

  std::vector<engine::Material> generated_materials(const v1::Object& message,
                                                    const engine::CellComplex& cells) const {
    std::vector<engine::Material> materials;
    for (const std::int32_t tag : cells.region_tags()) {
      const std::string& name = tag == engine::kInside ? message.inside() : message.outside();
      materials.push_back(materials_[static_cast<std::size_t>(material_names_.find("", name))]);
    }
    return materials;
  }

  std::vector<engine::Material> mesh_materials(const std::string& field, const v1::Object& message,
                                               const engine::CellComplex& cells) const {
    const auto tags = cells.region_tags();
    std::vector<engine::Material> materials(tags.size());
    std::vector<bool> told(tags.size(), false);
    for (int i = 0; i < message.region_size(); ++i) {
      const std::string region = field + "." + item("region", i);
      const auto found = std::lower_bound(tags.begin(), tags.end(), message.region(i).tag());
      if (found == tags.end() || *found != message.region(i).tag()) {
        source_.fail(region + ".tag", "the mesh has no region " + std::to_string(message.region(i).tag()) +
                                          "; it has " + list(tags));
      }
      const auto at = static_cast<std::size_t>(found - tags.begin());
      told[at] = true;
      materials[at] = materials_[static_cast<std::size_t>(
          material_names_.find(region + ".material", message.region(i).material()))];
    }
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (told[i]) continue;
      source_.fail(field + ".region", "region " + std::to_string(tags[i]) +
                                          " of the mesh has no material; the mesh has " + list(tags));
    }
    return materials;
  }

  static std::string list(std::span<const std::int32_t> tags) {
    constexpr std::size_t kMostTold = 20;
    std::string text;
    for (std::size_t i = 0; i < std::min(tags.size(), kMostTold); ++i) {
      text += (i == 0 ? "" : ", ") + std::to_string(tags[i]);
    }
    return text + (tags.size() > kMostTold ? ", ..." : "");
  }

  void dynamics(const std::string& field, const v1::Object::Dynamic& message, engine::Object& object) const {
    check_range(source_, field + ".linear_viscosity", message.linear_viscosity(), kViscosities);
    check_range(source_, field + ".angular_viscosity", message.angular_viscosity(), kAngularViscosities);
    check_range(source_, field + ".release_after", message.release_after(), kTimes);
    object.dynamic = true;
    object.release_after = message.release_after();
    object.dynamics.linear_viscosity = message.linear_viscosity();
    object.dynamics.angular_viscosity = message.angular_viscosity();
    object.dynamics.mass = mass_of(object);
    const engine::MassProperties& mass = object.dynamics.mass;
    const bool can_turn = mass.inertia.x > 0.0 && mass.inertia.y > 0.0 && mass.inertia.z > 0.0;
    if (!(mass.mass > 0.0) || !can_turn) {
      source_.fail(field, "an object that moves needs a mass: give one of its materials a density");
    }
  }

  // summing over cells is slow where there are many
  engine::MassProperties mass_of(const engine::Object& object) const {
    if (running_ != nullptr) {
      for (const engine::Object& other : running_->scene.objects) {
        const bool weighs_the_same =
            other.dynamic && other.cells == object.cells &&
            std::equal(other.materials.begin(), other.materials.end(), object.materials.begin(),
                       object.materials.end(), [](const engine::Material& a, const engine::Material& b) {
                         return a.density == b.density;
                       });
        if (weighs_the_same) return other.dynamics.mass;
      }
    }
    return engine::mass_properties(*object.cells, object.materials);
  }

  void finger(int index) {
    const v1::Finger& message = message_.finger(index);
    finger_names_.add(message.name(), index);
    scene_.fingers.push_back(
        make_finger(source_, item("finger", index), message, capacity_.hips() - hip_count_));
    hip_count_ += scene_.fingers.back().hips.size();
  }

  static constexpr const char* kMeshOnly = "a mesh has regions: name their materials by region instead";

  const v1::Scene& message_;
  engine::Scene& scene_;
  std::vector<std::string>& warnings_;
  const TextSource& source_;
  const std::filesystem::path* file_;
  const v1::Capacity& capacity_;
  const Built* running_;
  Names material_names_{source_, "material"};
  Names object_names_{source_, "object"};
  Names finger_names_{source_, "finger"};
  std::vector<engine::Material> materials_;
  using CellsOfShapes = std::map<CellsKey, std::shared_ptr<const engine::CellComplex>>;
  CellsOfShapes running_cells_;
  CellsOfShapes shared_cells_;
  std::size_t cell_count_ = 0;
  std::size_t hip_count_ = 0;
};

}  // namespace

std::shared_ptr<const LoadedScene> build_scene(v1::Scene message, const TextSource& source,
                                               const std::filesystem::path* file,
                                               const v1::Capacity& capacity, const Built* running) {
  const auto loaded = std::make_shared<LoadedScene>();
  loaded->message = std::move(message);
  SceneBuilder(*loaded, source, file, capacity, running).build();
  return loaded;
}

std::shared_ptr<const LoadedScene> build_scene(v1::Scene message, const v1::Capacity& capacity) {
  return build_scene(std::move(message), TextSource(), nullptr, capacity);
}

std::shared_ptr<const LoadedScene> load_scene(const std::filesystem::path& file,
                                              const v1::Capacity& capacity) {
  v1::Scene message;
  const TextSource source = read_message(file, message);
  return build_scene(std::move(message), source, &file, capacity);
}

}  // namespace haptic::load
