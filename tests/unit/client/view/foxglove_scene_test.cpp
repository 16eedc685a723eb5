#include "client/view/foxglove_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/glm.hpp>

namespace haptic::gateway {
namespace {

// Two tetrahedra that share the face (1, 2, 3): one to each side of the plane x + y + z = 1.
v1::SceneDescription two_cells() {
  v1::SceneDescription scene;
  v1::Scene& message = *scene.mutable_scene();
  v1::Material& wood = *message.add_material();
  wood.set_name("wood");
  wood.mutable_rigid();
  v1::Material& air = *message.add_material();
  air.set_name("air");
  air.mutable_free();
  v1::Object& object = *message.add_object();
  object.set_name("pair");
  for (const char* const material : {"wood", "air"}) {
    v1::Object::Region& region = *object.add_region();
    region.set_tag(object.region_size());
    region.set_material(material);
  }
  v1::Shape::Tetrahedra& mesh = *object.mutable_shape()->mutable_mesh()->mutable_embedded();
  for (const double x : {0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 1., 1., 1.}) {
    mesh.add_vertex(x);
  }
  for (const std::uint32_t vertex : {0U, 1U, 2U, 3U, 4U, 1U, 3U, 2U}) {
    mesh.add_cell(vertex);
  }
  mesh.add_tag(1);
  mesh.add_tag(1);
  return scene;
}

v1::Shape::Tetrahedra& mesh_of(v1::SceneDescription& scene) {
  return *scene.mutable_scene()->mutable_object(0)->mutable_shape()->mutable_mesh()->mutable_embedded();
}

// by the divergence theorem: a sixth of the sum of a . (b x c) of each triangle that is seen from outside
double volume_of(const view::Surface& surface) {
  const auto at = [&](std::size_t i) {
    const double* const p = surface.points.data() + std::size_t{3} * surface.indices[i];
    return glm::dvec3(p[0], p[1], p[2]);
  };
  double volume = 0.0;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    volume += glm::dot(at(i), glm::cross(at(i + 1), at(i + 2))) / 6.0;
  }
  return volume;
}

TEST(SurfacesOf, AMeshAreTheFacesThatOnlyOneCellHas) {
  const auto surfaces = surfaces_of(two_cells());
  ASSERT_EQ(surfaces.size(), 1U);
  EXPECT_EQ(surfaces[0].indices.size(), 3U * 6U);  // eight faces without the two that are shared
  EXPECT_EQ(surfaces[0].points.size(), 3U * 5U);
  // the corner of a cube has 1/6; from (1, 1, 1) to the plane it is 2/sqrt(3), the face has sqrt(3)/2: 1/3
  EXPECT_NEAR(volume_of(surfaces[0]), 1.0 / 6.0 + 1.0 / 3.0, 1e-15);
}

TEST(SurfacesOf, AMeshDoNotCountCellsWithoutResistance) {
  v1::SceneDescription scene = two_cells();
  mesh_of(scene).set_tag(1, 2);
  const auto surfaces = surfaces_of(scene);
  EXPECT_EQ(surfaces[0].indices.size(), 3U * 4U);
  EXPECT_EQ(surfaces[0].points.size(), 3U * 4U);
  EXPECT_NEAR(volume_of(surfaces[0]), 1.0 / 6.0, 1e-15);
}

TEST(SurfacesOf, OtherShapesAreEmpty) {
  v1::SceneDescription scene = two_cells();
  scene.mutable_scene()->add_object()->mutable_shape()->mutable_box();
  scene.mutable_scene()->add_object()->mutable_shape()->mutable_mesh()->set_path("a.msh");
  const auto surfaces = surfaces_of(scene);
  ASSERT_EQ(surfaces.size(), 3U);
  EXPECT_TRUE(surfaces[1].indices.empty());
  EXPECT_TRUE(surfaces[2].indices.empty());
}

TEST(SurfacesOf, AMeshWhoseCellsLieAreEmpty) {
  v1::SceneDescription scene = two_cells();
  mesh_of(scene).set_cell(7, 5);
  EXPECT_TRUE(surfaces_of(scene)[0].indices.empty());
  mesh_of(scene).set_cell(7, 2);
  mesh_of(scene).mutable_vertex()->RemoveLast();
  EXPECT_TRUE(surfaces_of(scene)[0].indices.empty());
}

TEST(SurfacesOf, AMeshAreDrawnAsTriangles) {
  const v1::SceneDescription scene = two_cells();
  const auto update = view::draw_shapes(scene, surfaces_of(scene), 5);
  ASSERT_EQ(update.entities_size(), 1);
  ASSERT_EQ(update.entities(0).triangles_size(), 1);
  EXPECT_EQ(update.entities(0).triangles(0).indices_size(), 18);
  EXPECT_EQ(update.entities(0).frame_id(), "object/pair");
}

}  // namespace
}  // namespace haptic::gateway
