#include "load/embedded_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "load/config_file.h"
#include "load/scene_file.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

std::shared_ptr<const LoadedScene> from_file() {
  return load_scene(kSource / "config/scenes/layers.scene.txtpb", default_capacity());
}

template <class T>
bool same_bits(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

// one tetrahedron
v1::Shape::Tetrahedra tetrahedron() {
  v1::Shape::Tetrahedra mesh;
  for (const double x : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) mesh.add_vertex(x);
  for (const std::uint32_t vertex : {0U, 1U, 2U, 3U}) mesh.add_cell(vertex);
  mesh.add_tag(7);
  return mesh;
}

v1::Scene scene_of(const v1::Shape::Tetrahedra& mesh) {
  v1::Scene scene;
  v1::Material& material = *scene.add_material();
  material.set_name("wood");
  material.mutable_rigid();
  v1::Object& object = *scene.add_object();
  object.set_name("thing");
  *object.mutable_shape()->mutable_mesh()->mutable_embedded() = mesh;
  object.add_region()->set_tag(7);
  object.mutable_region(0)->set_material("wood");
  return scene;
}

TEST(EmbeddedMesh, MakesOfASceneWithFilesOneThatCanBeSentAndIsTheSameToTheBit) {
  const auto loaded = from_file();
  v1::Scene message = loaded->message;
  ASSERT_TRUE(std::any_of(message.object().begin(), message.object().end(),
                          [](const v1::Object& object) { return object.shape().has_mesh(); }));
  embed_meshes(message, loaded->scene);
  const auto again = build_scene(message, default_capacity());
  ASSERT_EQ(again->scene.objects.size(), loaded->scene.objects.size());
  for (std::size_t i = 0; i < loaded->scene.objects.size(); ++i) {
    const engine::Object& before = loaded->scene.objects[i];
    const engine::Object& after = again->scene.objects[i];
    EXPECT_TRUE(same_bits(before.cells->vertices(), after.cells->vertices())) << before.name;
    EXPECT_TRUE(same_bits(before.cells->faces(), after.cells->faces())) << before.name;
    EXPECT_TRUE(std::ranges::equal(before.cells->region_tags(), after.cells->region_tags())) << before.name;
    EXPECT_TRUE(std::ranges::equal(before.cells->cells(), after.cells->cells(),
                                   [](const auto& a, const auto& b) {
                                     return a.vertices == b.vertices && a.region == b.region &&
                                            a.offset == b.offset;
                                   }))
        << before.name;
    EXPECT_EQ(before.dynamics.mass.mass, after.dynamics.mass.mass);
  }
}

TEST(EmbeddedMesh, IsBuiltAsTold) {
  const auto loaded = build_scene(scene_of(tetrahedron()), default_capacity());
  const engine::CellComplex& cells = *loaded->scene.objects[0].cells;
  ASSERT_EQ(cells.cells().size(), 1u);
  EXPECT_EQ(cells.region_tags()[0], 7);
  EXPECT_EQ(cells.vertices()[3].z, 1.0);
}

TEST(EmbeddedMesh, ThatIsWrongIsToldByItsField) {
  const auto field_of = [](const std::function<void(v1::Shape::Tetrahedra&)>& spoil) {
    v1::Shape::Tetrahedra mesh = tetrahedron();
    spoil(mesh);
    return error_of([&] { build_scene(scene_of(mesh), default_capacity()); }).field();
  };
  const std::string at = "object[0].shape.mesh.embedded";
  EXPECT_EQ(field_of([](auto& mesh) { mesh.clear_tag(); }), at + ".tag");
  EXPECT_EQ(field_of([](auto& mesh) { mesh.add_cell(0); }), at + ".cell");
  EXPECT_EQ(field_of([](auto& mesh) { mesh.add_vertex(0.5); }), at + ".vertex");
  EXPECT_EQ(field_of([](auto& mesh) { mesh.set_cell(2, 4); }), at + ".cell[2]");
  EXPECT_EQ(field_of([](auto& mesh) { mesh.set_vertex(5, 1e9); }), at + ".vertex[5]");
  EXPECT_EQ(field_of([](auto& mesh) { mesh.set_cell(2, 3), mesh.set_cell(3, 2); }),
            at + ".tag[0]");  // inverted
}

}  // namespace
}  // namespace haptic::load
