#include "proto/foxglove/scene_view.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace haptic::view {
namespace {

constexpr std::uint64_t kTime = 1'700'000'000'000'000'123;

template <class Message>
Message parse(const std::string& text) {
  Message message;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &message)) << text;
  return message;
}

v1::SceneDescription scene_with(const std::string& objects) {
  return parse<v1::SceneDescription>("scene { " + objects + " }");
}

TEST(DrawShapes, ReplacesAllThatWasDrawnBefore) {
  const auto update = draw_shapes(scene_with(""), {}, kTime);
  ASSERT_EQ(update.deletions_size(), 1);
  EXPECT_EQ(update.deletions(0).type(), ::foxglove::SceneEntityDeletion::ALL);
  EXPECT_EQ(update.deletions(0).timestamp().seconds(), 1'700'000'000);
  EXPECT_EQ(update.deletions(0).timestamp().nanos(), 123);
}

TEST(DrawShapes, DrawsEachShapeInTheFrameOfItsObject) {
  const auto update = draw_shapes(scene_with(R"(
    object { name: "brick" shape { box { size { x: 1 y: 2 z: 3 } } } }
    object { name: "ball" shape { icosphere { radius: 0.5 } } dynamic {} }
    object { name: "can" shape { cylinder { radius: 1 height: 4 } } }
    object { name: "prism" shape { extrusion { outline { x: 0 y: 0 } outline { x: 1 y: 0 } outline { x: 0 y: 1 } height: 2 } } }
    object { name: "pot" shape { mesh { path: "pot.msh" } } }
  )"),
                                  {}, kTime);
  ASSERT_EQ(update.entities_size(), 5);
  EXPECT_EQ(update.entities(0).frame_id(), "object/brick");
  EXPECT_TRUE(update.entities(0).frame_locked());
  EXPECT_EQ(update.entities(0).cubes(0).size().z(), 3.0);
  EXPECT_EQ(update.entities(0).cubes(0).pose().orientation().w(), 1.0);
  EXPECT_GT(update.entities(0).cubes(0).color().a(), 0.0);
  EXPECT_EQ(update.entities(1).spheres(0).size().x(), 1.0);
  EXPECT_EQ(update.entities(2).cylinders(0).size().y(), 2.0);
  EXPECT_EQ(update.entities(2).cylinders(0).size().z(), 4.0);
  EXPECT_EQ(update.entities(2).cylinders(0).top_scale(), 1.0);
  const auto& prism = update.entities(3).triangles(0);
  EXPECT_EQ(prism.points_size(), 6);
  EXPECT_EQ(prism.indices_size(), 3 * (1 + 1 + 3 * 2));  // floor, roof, and two for each wall
  EXPECT_EQ(prism.points(0).z(), -1.0);
  EXPECT_EQ(update.entities(4).texts(0).text(), "pot");
}

TEST(DrawShapes, ASurfaceThatIsGivenIsDrawn) {
  const std::vector<Surface> surfaces = {{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}}};
  const auto update = draw_shapes(scene_with(R"(object { name: "pot" shape { mesh {} } })"), surfaces, kTime);
  EXPECT_EQ(update.entities(0).texts_size(), 0);
  EXPECT_EQ(update.entities(0).triangles(0).points(1).x(), 1.0);
  EXPECT_EQ(update.entities(0).triangles(0).indices_size(), 3);
}

TEST(DrawPlaces, PlacesObjectsAndDevicesInTheWorld) {
  const auto scene = scene_with(R"(object { name: "a" } object { name: "b" })");
  const auto frame = parse<v1::Frame>(R"(
    realtime_ns: 5
    objects { position: [1, 2, 3, 4, 5, 6] orientation: [1, 0, 0, 0, 0, 1, 0, 0] }
    devices { position: [7, 8, 9] orientation: [1, 0, 0, 0] })");
  const std::vector<std::string> devices = {"left"};
  const auto transforms = draw_places(scene, devices, frame);
  ASSERT_EQ(transforms.transforms_size(), 3);
  EXPECT_EQ(transforms.transforms(1).parent_frame_id(), "world");
  EXPECT_EQ(transforms.transforms(1).child_frame_id(), "object/b");
  EXPECT_EQ(transforms.transforms(1).translation().y(), 5.0);
  EXPECT_EQ(transforms.transforms(1).rotation().x(), 1.0);  // w comes first in a frame
  EXPECT_EQ(transforms.transforms(1).rotation().w(), 0.0);
  EXPECT_EQ(transforms.transforms(2).child_frame_id(), "device/left");
  EXPECT_EQ(transforms.transforms(2).timestamp().nanos(), 5);
}

TEST(DrawPlaces, ObjectsThatASubscriptionSelectsKeepTheirNames) {
  const auto scene = scene_with(R"(object { name: "a" } object { name: "b" })");
  const auto frame = parse<v1::Frame>("objects { position: [1, 2, 3] orientation: [1, 0, 0, 0] object: 1 }");
  const auto transforms = draw_places(scene, {}, frame);
  ASSERT_EQ(transforms.transforms_size(), 1);
  EXPECT_EQ(transforms.transforms(0).child_frame_id(), "object/b");
}

TEST(DrawPlaces, WhatTheSceneDoesNotHaveIsLeftAway) {
  const auto frame = parse<v1::Frame>(R"(
    objects { position: [1, 2, 3] orientation: [1, 0, 0, 0] }
    devices { position: [7, 8, 9] orientation: [1, 0, 0, 0] })");
  EXPECT_EQ(draw_places(scene_with(""), {}, frame).transforms_size(), 0);
}

// where +x points after the rotation
std::array<double, 3> turned_x(const ::foxglove::Quaternion& q) {
  return {1 - 2 * (q.y() * q.y() + q.z() * q.z()), 2 * (q.x() * q.y() + q.w() * q.z()),
          2 * (q.x() * q.z() - q.w() * q.y())};
}

TEST(DrawHips, AnArrowPointsAlongTheForceAndIsAsLongAsItIsStrong) {
  for (const std::array<double, 3>& force :
       {std::array<double, 3>{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, 0, -2}, {1, -2, 3}}) {
    v1::Frame frame = parse<v1::Frame>("hips { position: [1, 2, 3] }");
    for (const double component : force) {
      frame.mutable_hips()->add_force(component);
    }
    const auto update = draw_hips(frame);
    ASSERT_EQ(update.entities(1).arrows_size(), 1);
    const auto& arrow = update.entities(1).arrows(0);
    const double magnitude = std::hypot(force[0], force[1], force[2]);
    EXPECT_DOUBLE_EQ(arrow.shaft_length() + arrow.head_length(), magnitude * kArrowMetresPerNewton);
    EXPECT_EQ(arrow.pose().position().z(), 3.0);
    const auto direction = turned_x(arrow.pose().orientation());
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(direction.at(i), force.at(i) / magnitude, 1e-12);
    }
  }
}

TEST(DrawHips, AHipWithoutForceHasNoArrow) {
  const auto update = draw_hips(parse<v1::Frame>("hips { position: [1, 2, 3] force: [0, 0, 0] }"));
  EXPECT_EQ(update.entities(0).spheres_size(), 1);
  EXPECT_EQ(update.entities(1).arrows_size(), 0);
}

TEST(DrawHips, FreeStickingAndSlippingHipsDifferInColour) {
  const auto update = draw_hips(parse<v1::Frame>(R"(
    hips {
      position: [0, 0, 0, 1, 0, 0, 2, 0, 0] force: [0, 0, 0, 0, 0, 1, 0, 0, 1]
      contact_hip: [1, 2] contact_object: [0, 0] contact_state: [SUR, SUR] contact_slipping: [false, true]
      contact_proxy: [1, 0, 0, 2, 0, 0] contact_force: [0, 0, 1, 0, 0, 1]
    })"));
  const auto& points = update.entities(0).spheres();
  ASSERT_EQ(points.size(), 3);
  EXPECT_NE(points[0].color().SerializeAsString(), points[1].color().SerializeAsString());
  EXPECT_NE(points[1].color().SerializeAsString(), points[2].color().SerializeAsString());
}

TEST(DrawHips, OfVeryManyOnlyThoseInContactAreDrawn) {
  v1::Frame frame;
  v1::HipsFrame& hips = *frame.mutable_hips();
  for (int i = 0; i < 3 * (kMostHips + 1); ++i) {
    hips.add_position(i);
    hips.add_force(0.0);
  }
  hips.add_contact_hip(7);
  for (const double component : {0.0, 0.0, 1.0}) {
    hips.add_contact_force(component);
  }
  const auto update = draw_hips(frame);
  ASSERT_EQ(update.entities(0).spheres_size(), 1);
  EXPECT_EQ(update.entities(0).spheres(0).pose().position().x(), 21.0);
}

TEST(LogOf, AFaultIsAnError) {
  v1::Event event;
  event.set_message("left: over speed");
  event.set_kind(v1::Event::FAULT_LATCHED);
  const auto log = log_of(event, kTime);
  EXPECT_EQ(log.level(), ::foxglove::Log::ERROR);
  EXPECT_EQ(log.message(), "left: over speed");
  EXPECT_EQ(log.timestamp().nanos(), 123);
  event.set_kind(v1::Event::ARMED);
  EXPECT_EQ(log_of(event, kTime).level(), ::foxglove::Log::INFO);
}

}  // namespace
}  // namespace haptic::view
