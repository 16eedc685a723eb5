#include "load/scene_file.h"

#include <cmath>

#include "load/config_file.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

using engine::Material;

const std::string kMaterials =
    "material { name: \"air\" free {} }\n"
    "material { name: \"wood\" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 } }\n"
    "material { name: \"gel\" density: 1000 yielding { force: 0.1 drag: 2 static_friction: 0.6 "
    "kinetic_friction: 0.3 } }\n"
    "material { name: \"water\" density: 998 viscous { drag: 3 } }\n";
const std::string kBox = "shape { box { size { x: 0.1 y: 0.2 z: 0.3 } } }";

std::shared_ptr<const LoadedScene> scene_of(const std::string& text,
                                            const v1::Capacity& capacity = default_capacity()) {
  v1::Scene message;
  const TextSource source = parse_message(text, "s.scene.txtpb", Syntax::kText, message);
  return build_scene(std::move(message), source, nullptr, capacity);
}

LoadError error_in(const std::string& text) {
  return error_of([&] { scene_of(text); });
}

const Material& material_at(const engine::Object& object, const glm::dvec3& point) {
  return object.materials[object.cells->cells()[object.cells->locate(point)].region];
}

TEST(Scene, MayBeEmpty) {
  const auto loaded = scene_of("");
  EXPECT_TRUE(loaded->scene.objects.empty());
  EXPECT_EQ(loaded->scene.hip_count, 0U);
  EXPECT_EQ(loaded->scene.gravity, glm::dvec3(0.0));
}

TEST(Scene, GivesTheInsideAndTheLayerAroundItTheirMaterials) {
  const auto loaded = scene_of(kMaterials + "object { name: \"a\" " + kBox +
                               " inside: \"wood\" outside: \"air\" air_margin: 0.02 }");
  const engine::Object& object = loaded->scene.objects[0];
  EXPECT_FALSE(object.dynamic);
  EXPECT_TRUE(engine::is_rigid(material_at(object, {0.01, 0.02, 0.03})));
  EXPECT_EQ(material_at(object, {0.01, 0.02, 0.03}).static_friction, 1.0);
  // half the box and half the layer above its top
  EXPECT_EQ(material_at(object, {0.01, 0.11, 0.02}).yield_force, 0.0);
}

TEST(Scene, TranslatesEachMotion) {
  const auto motion_of = [](const std::string& name) {
    return scene_of(kMaterials + "object { name: \"a\" " + kBox + " inside: \"" + name + "\" }")
        ->scene.objects[0]
        .materials[0];
  };
  EXPECT_EQ(motion_of("air").yield_force, 0.0);
  EXPECT_EQ(motion_of("wood").kinetic_friction, 0.5);
  EXPECT_EQ(motion_of("gel").yield_force, 0.1);
  EXPECT_EQ(motion_of("gel").drag, 2.0);
  EXPECT_EQ(motion_of("gel").static_friction, 0.6);
  EXPECT_EQ(motion_of("gel").density, 1000.0);
  EXPECT_EQ(motion_of("water").drag, 3.0);
  EXPECT_EQ(motion_of("water").yield_force, 0.0);
}

TEST(Scene, WeighsWhatMoves) {
  const auto loaded =
      scene_of(kMaterials + "object { name: \"a\" " + kBox +
               " inside: \"wood\" outside: \"air\" air_margin: 0.02"
               " dynamic { linear_viscosity: 0.8 angular_viscosity: 1e-4 release_after: 0.6 } }");
  const engine::Object& object = loaded->scene.objects[0];
  EXPECT_TRUE(object.dynamic);
  EXPECT_EQ(object.release_after, 0.6);
  EXPECT_EQ(object.dynamics.linear_viscosity, 0.8);
  // 500 kg/m^3 * 0.1 * 0.2 * 0.3 m^3; the air around it has no density
  EXPECT_NEAR(object.dynamics.mass.mass, 3.0, 1e-12);
}

TEST(Scene, ReadsAZeroQuaternionAsTheIdentityAndNormalisesAnyOther) {
  const auto turned = [](const std::string& orientation) {
    return scene_of(kMaterials + "object { name: \"a\" " + kBox +
                    " inside: \"wood\" pose { position { y: 1 } " + orientation + " } }")
        ->scene.objects[0]
        .initial_pose;
  };
  EXPECT_EQ(turned("").orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(turned("orientation { }").orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(turned("orientation { w: -2 }").orientation, glm::dquat(-1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(turned("orientation { w: 1e-300 }").orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(turned("orientation { x: 1e300 }").orientation, glm::dquat(0.0, 1.0, 0.0, 0.0));
  EXPECT_EQ(turned("").position, glm::dvec3(0.0, 1.0, 0.0));
}

TEST(Scene, NumbersTheHipsOfItsFingers) {
  const auto loaded = scene_of(
      "finger { name: \"a\" device: \"d\" stiffness: 1 point {} }"
      "finger { name: \"b\" device: \"d\" stiffness: 2 line { start { x: -1 } end { x: 1 } hips: 3 } }"
      "finger { name: \"c\" device: \"e\" stiffness: 3 points { hip { x: 1 } hip { y: 2 } } }"
      "finger { name: \"t\" device: \"e\" stiffness: 4 fingertip { radius: 0.01 cap_angle: 0.5 hips: 11 "
      "direction { z: 1 } } }");
  const auto& fingers = loaded->scene.fingers;
  ASSERT_EQ(fingers.size(), 4U);
  EXPECT_EQ(fingers[1].first_hip, 1U);
  EXPECT_EQ(fingers[1].hips[2], glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(fingers[2].first_hip, 4U);
  EXPECT_EQ(fingers[2].hips[1], glm::dvec3(0.0, 2.0, 0.0));
  EXPECT_EQ(fingers[3].hips[0], glm::dvec3(0.0, 0.0, 0.01));
  EXPECT_EQ(loaded->scene.hip_count, 17U);
}

TEST(Scene, SharesTheCellsOfEqualShapes) {
  const auto loaded =
      scene_of(kMaterials + "object { name: \"a\" " + kBox + " inside: \"wood\" } object { name: \"b\" " +
               kBox + " inside: \"gel\" } object { name: \"c\" " + kBox +
               " inside: \"gel\" outside: \"air\" air_margin: 0.01 }");
  EXPECT_EQ(loaded->scene.objects[0].cells, loaded->scene.objects[1].cells);
  EXPECT_NE(loaded->scene.objects[0].cells, loaded->scene.objects[2].cells);
  EXPECT_TRUE(engine::is_rigid(loaded->scene.objects[0].materials[0]));
  EXPECT_FALSE(engine::is_rigid(loaded->scene.objects[1].materials[0]));
}

TEST(Scene, TellsWhichMaterialsThereAre) {
  EXPECT_STREQ(
      error_in(
          "material { name: \"air\" free {} }\nmaterial { name: \"wood\" rigid {} }\nobject { name: \"a\" " +
          kBox + "\n  inside: \"wod\" }")
          .what(),
      "s.scene.txtpb:4:3: object[0].inside: no material is named \"wod\"; known: air, wood");
}

TEST(Scene, TellsFieldAndRangeOfASize) {
  EXPECT_STREQ(
      error_in(kMaterials +
               "object {\n name: \"a\" shape { box { size { x: 1 y: -1 z: 1 } } }\n inside: \"wood\" }")
          .what(),
      "s.scene.txtpb:6:38: object[0].shape.box.size.y: -1 is out of range (permitted: 1e-06 to 1e+06 m)");
}

TEST(Scene, KeepsToTheCapacityOfTheDaemon) {
  v1::Capacity capacity = default_capacity();
  capacity.set_objects(1);
  capacity.set_fingers(2);
  capacity.set_hips(3);
  const std::string object = "object { name: \"%\" " + kBox + " inside: \"wood\" }\n";
  const auto error_with = [&](const std::string& text) {
    return error_of([&] { scene_of(kMaterials + text, capacity); });
  };
  EXPECT_EQ(error_with(object + "object { name: \"b\" " + kBox + " inside: \"wood\" }").field(), "object[1]");
  const auto finger = [](const std::string& name, const std::string& layout) {
    return "finger { name: \"" + name + "\" device: \"d\" stiffness: 1 " + layout + " }\n";
  };
  EXPECT_NO_THROW(scene_of(finger("a", "point {}") + finger("b", "line { hips: 2 }"), capacity));
  EXPECT_EQ(error_with(finger("a", "point {}") + finger("b", "line { hips: 3 }")).field(),
            "finger[1].line.hips");
  EXPECT_EQ(error_with(finger("a", "line { hips: 3 }") + finger("b", "point {}")).field(), "finger[1].point");
  EXPECT_EQ(error_with(finger("a", "point {}") + finger("b", "point {}") + finger("c", "point {}")).field(),
            "finger[2]");
}

TEST(Scene, ThatAClientSendsReadsNoFile) {
  v1::Scene message;
  v1::Object& object = *message.add_object();
  object.set_name("a");
  object.mutable_shape()->mutable_mesh()->set_path("/etc/passwd");
  const LoadError error = error_of([&] { build_scene(message, default_capacity()); });
  EXPECT_STREQ(error.what(), "object[0].shape.mesh.path: is refused: a scene that is sent cannot name files");
  EXPECT_EQ(error.file(), "");
}

TEST(Scene, ThatAClientSendsIsCheckedForNumbersThatAreNotFinite) {
  v1::Scene message;
  message.mutable_gravity()->set_z(std::nan(""));
  EXPECT_EQ(error_of([&] { build_scene(message, default_capacity()); }).field(), "gravity.z");
}

/// A scene with the corner cell of the origin as a mesh, regions as told.
class MeshScene : public testing::Test {
 protected:
  std::shared_ptr<const LoadedScene> load(const std::string& cells, const std::string& rest) const {
    folder_.write("m.node", nodes_);
    folder_.write("m.ele", cells);
    return load_scene(
        folder_.write("s.scene.txtpb", kMaterials + "object { name: \"a\"\n shape { mesh { path: \"m.ele\" " +
                                           scale_ + " } }\n " + rest + " }"),
        default_capacity());
  }
  LoadError error(const std::string& cells, const std::string& rest) const {
    return error_of([&] { load(cells, rest); });
  }

  TemporaryFolder folder_;
  std::string scale_;
  std::string nodes_ = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";
  const std::string good_ = "1 4 1\n0 0 1 2 3 5\n";
};

TEST_F(MeshScene, GivesEachRegionItsMaterial) {
  EXPECT_EQ(load(good_, "region { tag: 5 material: \"gel\" }")->scene.objects[0].materials[0].yield_force,
            0.1);
}

TEST_F(MeshScene, IsScaledToMetres) {
  scale_ = "scale: 0.001";
  EXPECT_EQ(load(good_, "region { tag: 5 material: \"gel\" }")->scene.objects[0].cells->bounds().high,
            glm::dvec3(0.001));
}

TEST_F(MeshScene, NeedsAMaterialForEachRegion) {
  const LoadError missing = error(good_, "");
  EXPECT_EQ(missing.field(), "object[0].region");
  EXPECT_EQ(missing.message(), "region 5 of the mesh has no material; the mesh has 5");
  EXPECT_EQ(missing.line(), 5U);
}

TEST_F(MeshScene, RefusesARegionThatDoesNotOccur) {
  const LoadError wrong =
      error(good_, "region { tag: 5 material: \"gel\" } region { tag: 6 material: \"gel\" }");
  EXPECT_EQ(wrong.field(), "object[0].region[1].tag");
  EXPECT_EQ(wrong.message(), "the mesh has no region 6; it has 5");
}

TEST_F(MeshScene, TellsTheLineOfTheMeshFileAndTheField) {
  const LoadError cut = error("1 4 1\n0 0 1 2\n", "region { tag: 5 material: \"gel\" }");
  EXPECT_EQ(cut.file(), (folder_.path() / "m.ele").string());
  EXPECT_EQ(cut.line(), 2U);
  EXPECT_EQ(cut.field(), "object[0].shape.mesh.path");
}

TEST_F(MeshScene, TellsTheLineOfACellThatTheEngineRefuses) {
  nodes_ = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 1 1 0\n";
  const LoadError flat = error("1 4 1\n# flat\n0 0 1 2 3 5\n", "region { tag: 5 material: \"gel\" }");
  EXPECT_EQ(flat.file(), (folder_.path() / "m.ele").string());
  EXPECT_EQ(flat.line(), 3U);
}

TEST_F(MeshScene, TellsTheSceneFileIfTheMeshIsMissing) {
  const auto scene = folder_.write("t.scene.txtpb",
                                   kMaterials + "object { name: \"a\" shape { mesh { path: \"n.ele\" } } }");
  const LoadError missing = error_of([&] { load_scene(scene, default_capacity()); });
  EXPECT_EQ(missing.file(), scene.string());
  EXPECT_EQ(missing.line(), 5U);
  EXPECT_EQ(missing.field(), "object[0].shape.mesh.path");
}

}  // namespace
}  // namespace haptic::load
