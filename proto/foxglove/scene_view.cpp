#include "proto/foxglove/scene_view.h"

#include <algorithm>
#include <cmath>

#include "proto/foxglove/outline.h"

namespace haptic::view {
namespace {

constexpr const char* kWorld = "world";
constexpr double kHipDiameter = 0.002;    // m
constexpr double kShaftDiameter = 0.001;  // m
constexpr double kHeadDiameter = 0.003;   // m
constexpr double kHeadShare = 0.25;       // of an arrow's length
constexpr double kNoForce = 1e-6;         // N; has no arrow
constexpr double kNameHeight = 0.01;      // m

struct Rgba {
  double r, g, b, a;
};
constexpr Rgba kFixed{0.55, 0.6, 0.65, 0.6};
constexpr Rgba kMovable{0.35, 0.55, 0.8, 0.6};
constexpr Rgba kFree{0.6, 0.6, 0.6, 1.0};
constexpr Rgba kSticking{0.2, 0.7, 0.3, 1.0};
constexpr Rgba kSlipping{0.95, 0.55, 0.1, 1.0};
constexpr Rgba kForce{0.85, 0.15, 0.15, 1.0};

void set(google::protobuf::Timestamp& out, std::uint64_t time_ns) {
  out.set_seconds(static_cast<std::int64_t>(time_ns / 1'000'000'000));
  out.set_nanos(static_cast<std::int32_t>(time_ns % 1'000'000'000));
}

template <class Vector>
void set(Vector& out, double x, double y, double z) {
  out.set_x(x);
  out.set_y(y);
  out.set_z(z);
}

void set(::foxglove::Quaternion& out, double w, double x, double y, double z) {
  out.set_w(w);
  out.set_x(x);
  out.set_y(y);
  out.set_z(z);
}

void set(::foxglove::Color& out, const Rgba& colour) {
  out.set_r(colour.r);
  out.set_g(colour.g);
  out.set_b(colour.b);
  out.set_a(colour.a);
}

void set_origin(::foxglove::Pose& out) {
  set(*out.mutable_position(), 0.0, 0.0, 0.0);
  set(*out.mutable_orientation(), 1.0, 0.0, 0.0, 0.0);
}

std::string object_frame(const std::string& name) { return "object/" + name; }
std::string device_frame(const std::string& name) { return "device/" + name; }

::foxglove::SceneEntity& add_entity(::foxglove::SceneUpdate& update, const std::string& frame,
                                    const std::string& id, std::uint64_t time_ns) {
  ::foxglove::SceneEntity& entity = *update.add_entities();
  set(*entity.mutable_timestamp(), time_ns);
  entity.set_frame_id(frame);
  entity.set_id(id);
  entity.set_frame_locked(true);
  return entity;
}

void draw(const Surface& surface, const Rgba& colour, ::foxglove::SceneEntity& entity) {
  ::foxglove::TriangleListPrimitive& triangles = *entity.add_triangles();
  set_origin(*triangles.mutable_pose());
  set(*triangles.mutable_color(), colour);
  for (std::size_t i = 0; i + 2 < surface.points.size(); i += 3) {
    set(*triangles.add_points(), surface.points[i], surface.points[i + 1], surface.points[i + 2]);
  }
  triangles.mutable_indices()->Assign(surface.indices.begin(), surface.indices.end());
}

// two copies of the outline, the floor first, with triangles between
Surface surface_of(const v1::Shape::Extrusion& extrusion) {
  std::vector<std::array<double, 2>> outline;
  outline.reserve(static_cast<std::size_t>(extrusion.outline_size()));
  for (const v1::Vector2& point : extrusion.outline()) {
    outline.push_back({point.x(), point.y()});
  }
  Surface surface;
  for (const double z : {-0.5 * extrusion.height(), 0.5 * extrusion.height()}) {
    for (const auto& [x, y] : outline) {
      surface.points.insert(surface.points.end(), {x, y, z});
    }
  }
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const auto& [a, b, c] : triangulate(outline)) {
    surface.indices.insert(surface.indices.end(), {a, c, b, n + a, n + b, n + c});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    surface.indices.insert(surface.indices.end(), {i, next, n + next, i, n + next, n + i});
  }
  return surface;
}

void draw(const v1::Object& object, const Rgba& colour, ::foxglove::SceneEntity& entity) {
  const auto with_size = [&](auto& primitive, double x, double y, double z) {
    set_origin(*primitive.mutable_pose());
    set(*primitive.mutable_size(), x, y, z);
    set(*primitive.mutable_color(), colour);
  };
  const v1::Shape& shape = object.shape();
  switch (shape.kind_case()) {
    case v1::Shape::kBox: {
      const v1::Vector3& size = shape.box().size();
      with_size(*entity.add_cubes(), size.x(), size.y(), size.z());
      break;
    }
    case v1::Shape::kIcosphere: {
      const double diameter = 2.0 * shape.icosphere().radius();
      with_size(*entity.add_spheres(), diameter, diameter, diameter);
      break;
    }
    case v1::Shape::kCylinder: {
      ::foxglove::CylinderPrimitive& cylinder = *entity.add_cylinders();
      const double diameter = 2.0 * shape.cylinder().radius();
      with_size(cylinder, diameter, diameter, shape.cylinder().height());
      cylinder.set_bottom_scale(1.0);
      cylinder.set_top_scale(1.0);
      break;
    }
    case v1::Shape::kExtrusion:
      draw(surface_of(shape.extrusion()), colour, entity);
      break;
    case v1::Shape::kMesh:
    case v1::Shape::KIND_NOT_SET: {
      ::foxglove::TextPrimitive& text = *entity.add_texts();
      set_origin(*text.mutable_pose());
      set(*text.mutable_color(), {colour.r, colour.g, colour.b, 1.0});
      text.set_billboard(true);
      text.set_font_size(kNameHeight);
      text.set_text(object.name());
      break;
    }
  }
}

void draw_force(const double* at, const double* force, ::foxglove::SceneEntity& entity) {
  const double magnitude = std::hypot(force[0], force[1], force[2]);
  if (!(magnitude > kNoForce) || !std::isfinite(magnitude)) {
    return;
  }
  const double x = force[0] / magnitude;
  const double y = force[1] / magnitude;
  const double z = force[2] / magnitude;
  ::foxglove::ArrowPrimitive& arrow = *entity.add_arrows();
  set(*arrow.mutable_pose()->mutable_position(), at[0], at[1], at[2]);
  // the shortest turn of +x to the direction: (1 + x . d, x cross d), of length sqrt(2 (1 + x . d))
  const double length = std::sqrt(2.0 * (1.0 + x));
  auto& turn = *arrow.mutable_pose()->mutable_orientation();
  if (length > 1e-6) {
    set(turn, (1.0 + x) / length, 0.0, -z / length, y / length);
  } else {
    set(turn, 0.0, 0.0, 0.0, 1.0);
  }
  const double total = magnitude * kArrowMetresPerNewton;
  arrow.set_shaft_length((1.0 - kHeadShare) * total);
  arrow.set_shaft_diameter(kShaftDiameter);
  arrow.set_head_length(kHeadShare * total);
  arrow.set_head_diameter(kHeadDiameter);
  set(*arrow.mutable_color(), kForce);
}

// by number of the HIP
struct Touch {
  bool touches = false;
  bool slips = false;
};

std::vector<Touch> touches_of(const v1::HipsFrame& hips, std::size_t count) {
  std::vector<Touch> touches(count);
  for (int i = 0; i < hips.contact_hip_size() && 3 * i + 2 < hips.contact_force_size(); ++i) {
    const double* const force = hips.contact_force().data() + std::ptrdiff_t{3} * i;
    if (hips.contact_hip(i) < count && std::hypot(force[0], force[1], force[2]) > kNoForce) {
      Touch& touch = touches[hips.contact_hip(i)];
      touch.touches = true;
      touch.slips = touch.slips || (i < hips.contact_slipping_size() && hips.contact_slipping(i));
    }
  }
  return touches;
}

// adds one transform for each item of packed positions and orientations
template <class Items>
void draw_items(const Items& items, std::uint64_t time_ns, ::foxglove::FrameTransforms& out,
                const auto& frame_of) {
  for (int i = 0; 3 * i + 2 < items.position_size() && 4 * i + 3 < items.orientation_size(); ++i) {
    const std::string frame = frame_of(i);
    if (frame.empty()) {
      continue;
    }
    ::foxglove::FrameTransform& transform = *out.add_transforms();
    set(*transform.mutable_timestamp(), time_ns);
    transform.set_parent_frame_id(kWorld);
    transform.set_child_frame_id(frame);
    set(*transform.mutable_translation(), items.position(3 * i), items.position(3 * i + 1),
        items.position(3 * i + 2));
    set(*transform.mutable_rotation(), items.orientation(4 * i), items.orientation(4 * i + 1),
        items.orientation(4 * i + 2), items.orientation(4 * i + 3));
  }
}

}  // namespace

::foxglove::SceneUpdate draw_shapes(const v1::SceneDescription& scene, std::span<const Surface> surfaces,
                                    std::uint64_t time_ns) {
  ::foxglove::SceneUpdate update;
  ::foxglove::SceneEntityDeletion& deletion = *update.add_deletions();
  set(*deletion.mutable_timestamp(), time_ns);
  deletion.set_type(::foxglove::SceneEntityDeletion::ALL);
  std::size_t i = 0;
  for (const v1::Object& object : scene.scene().object()) {
    const Rgba& colour = object.has_dynamic() ? kMovable : kFixed;
    ::foxglove::SceneEntity& entity = add_entity(update, object_frame(object.name()), object.name(), time_ns);
    if (i < surfaces.size() && !surfaces[i].indices.empty()) {
      draw(surfaces[i], colour, entity);
    } else {
      draw(object, colour, entity);
    }
    ++i;
  }
  return update;
}

::foxglove::FrameTransforms draw_places(const v1::SceneDescription& scene,
                                        std::span<const std::string> devices, const v1::Frame& frame) {
  ::foxglove::FrameTransforms out;
  const v1::ObjectsFrame& objects = frame.objects();
  draw_items(objects, frame.realtime_ns(), out, [&](int i) {
    const bool selects = objects.object_size() > 0;
    const auto index =
        selects && i < objects.object_size() ? objects.object(i) : static_cast<std::uint32_t>(i);
    const auto known = static_cast<std::uint32_t>(scene.scene().object_size());
    return index < known ? object_frame(scene.scene().object(static_cast<int>(index)).name()) : std::string();
  });
  draw_items(frame.devices(), frame.realtime_ns(), out, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    return index < devices.size() ? device_frame(devices[index]) : std::string();
  });
  return out;
}

::foxglove::SceneUpdate draw_hips(const v1::Frame& frame) {
  const v1::HipsFrame& hips = frame.hips();
  const int count = std::min(hips.position_size(), hips.force_size()) / 3;
  const auto number = [&](int i) {
    return static_cast<std::size_t>(i < hips.hip_size() ? hips.hip(i) : static_cast<std::uint32_t>(i));
  };
  std::size_t numbers = 0;
  for (int i = 0; i < count; ++i) {
    numbers = std::max(numbers, number(i) + 1);
  }
  // numbers from a file may be anything
  const std::vector<Touch> touches = touches_of(hips, std::min<std::size_t>(numbers, 1U << 20U));
  ::foxglove::SceneUpdate update;
  ::foxglove::SceneEntity& points = add_entity(update, kWorld, "HIPs", frame.realtime_ns());
  ::foxglove::SceneEntity forces;
  int drawn = 0;
  for (int i = 0; i < count && drawn < kMostHips; ++i) {
    const Touch touch = number(i) < touches.size() ? touches[number(i)] : Touch{};
    if (count > kMostHips && !touch.touches) {
      continue;
    }
    const double* const at = hips.position().data() + std::ptrdiff_t{3} * i;
    if (!std::isfinite(at[0]) || !std::isfinite(at[1]) || !std::isfinite(at[2])) {
      continue;
    }
    ++drawn;
    ::foxglove::SpherePrimitive& point = *points.add_spheres();
    set_origin(*point.mutable_pose());
    set(*point.mutable_pose()->mutable_position(), at[0], at[1], at[2]);
    set(*point.mutable_size(), kHipDiameter, kHipDiameter, kHipDiameter);
    set(*point.mutable_color(), !touch.touches ? kFree : touch.slips ? kSlipping : kSticking);
    draw_force(at, hips.force().data() + std::ptrdiff_t{3} * i, forces);
  }
  ::foxglove::SceneEntity& arrows = add_entity(update, kWorld, "forces", frame.realtime_ns());
  *arrows.mutable_arrows() = forces.arrows();
  return update;
}

::foxglove::Log log_of(const v1::Event& event, std::uint64_t time_ns) {
  ::foxglove::Log log;
  set(*log.mutable_timestamp(), time_ns);
  log.set_name("hapticd");
  log.set_message(event.message());
  log.set_level(event.kind() == v1::Event::FAULT_LATCHED  ? ::foxglove::Log::ERROR
                : event.kind() == v1::Event::TICKS_MISSED ? ::foxglove::Log::WARNING
                                                          : ::foxglove::Log::INFO);
  return log;
}

}  // namespace haptic::view
