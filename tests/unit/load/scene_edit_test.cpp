#include "load/scene_edit.h"

#include <gtest/gtest.h>

#include <limits>

#include "load/config_file.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

const std::string kScene = R"(
  material { name: "air" free {} }
  material { name: "wood" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 } }
  material { name: "spare" viscous { drag: 3 } }
  object { name: "box" shape { box { size { x: 0.1 y: 0.1 z: 0.1 } } } inside: "wood" dynamic {} }
  object { name: "ball" shape { icosphere { radius: 0.1 subdivisions: 1 } } inside: "wood" outside: "air" air_margin: 0.05 }
  finger { name: "index" device: "left" stiffness: 100 point {} }
)";

v1::Scene scene() {
  v1::Scene message;
  parse_message(kScene, "", Syntax::kText, message);
  return message;
}

v1::EditScene request_of(const std::string& edits) {
  v1::EditScene request;
  parse_message(edits, "", Syntax::kText, request);
  return request;
}

EditedScene edited(const std::string& edits) { return edit_scene(scene(), request_of(edits)); }

/// The edited scene, built beside the one before.
std::shared_ptr<const LoadedScene> built(const std::string& edits) {
  const auto running = build_scene(scene(), default_capacity());
  return build_edited(edited(edits), {running->message, running->scene}, default_capacity());
}

const std::string kCup = "shape { cylinder { radius: 0.1 height: 0.1 segments: 8 } } inside: \"wood\" ";

TEST(SceneEdit, AddsAnObjectAtTheEnd) {
  const auto loaded = built("edit { add_object { name: \"cup\" " + kCup + "} }");
  ASSERT_EQ(loaded->scene.objects.size(), 3U);
  EXPECT_EQ(loaded->scene.objects[2].name, "cup");
  EXPECT_EQ(origins(edited("edit { add_object { name: \"cup\" " + kCup + "} }").objects),
            (std::vector<engine::Index>{0, 1, engine::kNone}));
}

TEST(SceneEdit, RemovesAnObject) {
  const EditedScene after = edited("edit { remove_object: \"box\" }");
  ASSERT_EQ(after.message.object_size(), 1);
  EXPECT_EQ(after.message.object(0).name(), "ball");
  EXPECT_EQ(origins(after.objects), (std::vector<engine::Index>{1}));
}

TEST(SceneEdit, MovesAnObjectWhichThenComesFromNowhere) {
  const EditedScene after = edited("edit { move_object { name: \"ball\" pose { position { x: 2 } } } }");
  EXPECT_EQ(after.message.object(1).pose().position().x(), 2.0);
  EXPECT_EQ(origins(after.objects), (std::vector<engine::Index>{0, engine::kNone}));
}

TEST(SceneEdit, SetsTheNamedFieldsOfAnObjectAlone) {
  const EditedScene after = edited(
      "edit { set_object { object { name: \"box\" inside: \"spare\" air_margin: 0.3 "
      "dynamic { linear_viscosity: 2 release_after: 9 } } field: \"dynamic.linear_viscosity\" field: "
      "\"inside\" } }");
  const v1::Object& box = after.message.object(0);
  EXPECT_EQ(box.inside(), "spare");
  EXPECT_EQ(box.dynamic().linear_viscosity(), 2.0);
  EXPECT_EQ(box.dynamic().release_after(), 0.0);
  EXPECT_EQ(box.air_margin(), 0.0);
  EXPECT_EQ(origins(after.objects), (std::vector<engine::Index>{0, 1}));
}

TEST(SceneEdit, ClearsAFieldThatIsNamedButNotGiven) {
  EXPECT_FALSE(edited("edit { set_object { object { name: \"box\" } field: \"dynamic\" } }")
                   .message.object(0)
                   .has_dynamic());
  // neither has it: it does not come into being by being named
  EXPECT_FALSE(edited("edit { set_object { object { name: \"ball\" } field: \"dynamic.release_after\" } }")
                   .message.object(1)
                   .has_dynamic());
}

TEST(SceneEdit, SetsAnotherKindOfShape) {
  const std::string to_ball =
      "edit { set_object { object { name: \"box\" shape { icosphere { radius: 0.2 } } } ";
  EXPECT_EQ(edited(to_ball + "field: \"shape.icosphere\" } }").message.object(0).shape().icosphere().radius(),
            0.2);
  EXPECT_EQ(edited(to_ball + "field: \"shape\" } }").message.object(0).shape().icosphere().radius(), 0.2);
  // the request has no box
  EXPECT_FALSE(edited(to_ball + "field: \"shape.box\" } }").message.object(0).shape().has_icosphere());
}

TEST(SceneEdit, SettingAPoseIsMoving) {
  const EditedScene after = edited(
      "edit { set_object { object { name: \"box\" pose { position { y: 1 } } } field: \"pose.position.y\" } "
      "}");
  EXPECT_EQ(after.message.object(0).pose().position().y(), 1.0);
  EXPECT_EQ(origins(after.objects)[0], engine::kNone);
}

TEST(SceneEdit, AddsSetsAndRemovesMaterials) {
  const EditedScene after = edited(
      "edit { add_material { name: \"gel\" viscous { drag: 1 } } } "
      "edit { set_material { name: \"wood\" density: 700 rigid {} } } "
      "edit { remove_material: \"spare\" }");
  ASSERT_EQ(after.message.material_size(), 3);
  EXPECT_EQ(after.message.material(1).density(), 700.0);
  EXPECT_EQ(after.message.material(2).name(), "gel");
}

TEST(SceneEdit, SetsGravity) {
  EXPECT_EQ(built("edit { set_gravity { z: -9.81 } }")->scene.gravity.z, -9.81);
}

TEST(SceneEdit, AddsSetsAndRemovesFingers) {
  const auto after = built(
      "edit { add_finger { name: \"thumb\" device: \"left\" stiffness: 50 point {} } } "
      "edit { set_finger { name: \"index\" device: \"left\" stiffness: 70 point {} } }");
  ASSERT_EQ(after->scene.fingers.size(), 2U);
  EXPECT_EQ(after->scene.fingers[0].stiffness, 70.0);
  EXPECT_EQ(edited("edit { remove_finger: \"index\" }").message.finger_size(), 0);
}

TEST(SceneEdit, LaterEditsSeeTheSceneAsTheEarlierOnesLeftIt) {
  const EditedScene after =
      edited("edit { remove_object: \"box\" } edit { add_object { name: \"box\" " + kCup +
             "} } "
             "edit { move_object { name: \"box\" pose { position { x: 1 } } } }");
  ASSERT_EQ(after.message.object_size(), 2);
  EXPECT_TRUE(after.message.object(1).shape().has_cylinder());
  EXPECT_EQ(after.message.object(1).pose().position().x(), 1.0);
  EXPECT_EQ(origins(after.objects), (std::vector<engine::Index>{1, engine::kNone}));
}

// what is wrong, and the field that is told
struct Wrong {
  const char* edits;
  const char* field;
  const char* word;  // in the message
};

class WrongEdit : public testing::TestWithParam<Wrong> {};

TEST_P(WrongEdit, IsRefusedByFieldAndReason) {
  const LoadError error = error_of([] { built(GetParam().edits); });
  EXPECT_EQ(error.field(), GetParam().field) << error.what();
  EXPECT_NE(error.message().find(GetParam().word), std::string::npos) << error.what();
}

INSTANTIATE_TEST_SUITE_P(
    SceneEdit, WrongEdit,
    testing::Values(
        Wrong{"", "edit", "missing"}, Wrong{"edit {}", "edit[0]", "nothing to do"},
        Wrong{"edit { set_gravity {} } edit { add_object {} }", "edit[1].add_object.name", "missing"},
        Wrong{"edit { add_object { name: \"box\" } }", "edit[0].add_object.name", "already"},
        Wrong{"edit { add_object { name: \"a\" } }", "edit[0].add_object.shape", "has no kind"},
        Wrong{
            "edit { add_object { name: \"a\" shape { box { size { x: -1 y: 1 z: 1 } } } inside: \"wood\" } }",
            "edit[0].add_object.shape.box.size.x", "permitted"},
        Wrong{"edit { add_object { name: \"a\" shape { mesh { path: \"/etc/passwd\" } } } }",
              "edit[0].add_object.shape.mesh.path", "cannot name files"},
        Wrong{"edit { remove_object: \"cup\" }", "edit[0].remove_object", "there is no object \"cup\""},
        Wrong{"edit { remove_object: \"box\" } edit { remove_object: \"box\" }", "edit[1].remove_object",
              "there is no object"},
        Wrong{"edit { move_object { name: \"cup\" } }", "edit[0].move_object.name", "there is no object"},
        Wrong{"edit { remove_object: \"box\" } edit { move_object { name: \"ball\" pose { position { x: 1e9 "
              "} } } }",
              "edit[1].move_object.pose.position.x", "permitted"},
        Wrong{"edit { set_object { object { name: \"cup\" } field: \"inside\" } }",
              "edit[0].set_object.object.name", "there is no object"},
        Wrong{"edit { set_object { object { name: \"box\" } } }", "edit[0].set_object.field", "missing"},
        Wrong{"edit { set_object { object { name: \"box\" } field: \"inside\" field: \"weight\" } }",
              "edit[0].set_object.field[1]", "name, shape, inside, outside, air_margin"},
        Wrong{"edit { set_object { object { name: \"box\" } field: \"dynamic.weight\" } }",
              "edit[0].set_object.field[0]", "linear_viscosity, angular_viscosity, release_after"},
        Wrong{"edit { set_object { object { name: \"ball\" } field: \"dynamic.weight\" } }",
              "edit[0].set_object.field[0]", "linear_viscosity"},
        Wrong{"edit { set_object { object { name: \"box\" } field: \"inside.\" } }",
              "edit[0].set_object.field[0]", "no fields of its own"},
        Wrong{"edit { set_object { object { name: \"box\" } field: \"region.tag\" } }",
              "edit[0].set_object.field[0]", "as a whole"},
        Wrong{"edit { set_object { object { name: \"box\" } field: \"\" } }", "edit[0].set_object.field[0]",
              "is no field of Object"},
        Wrong{"edit { set_object { object { name: \"box\" inside: \"lead\" } field: \"inside\" } }",
              "edit[0].set_object.object.inside", "lead"},
        Wrong{"edit { set_object { object { name: \"box\" shape { mesh { path: \"a.msh\" } } } field: "
              "\"shape.mesh\" } }",
              "edit[0].set_object.object.shape.mesh", "cannot name files"},
        Wrong{"edit { add_material { name: \"wood\" } }", "edit[0].add_material.name", "already"},
        Wrong{"edit { add_material { name: \"m\" density: -1 free {} } }", "edit[0].add_material.density",
              "permitted"},
        Wrong{"edit { set_material { name: \"iron\" } }", "edit[0].set_material.name",
              "there is no material"},
        Wrong{"edit { remove_material: \"iron\" }", "edit[0].remove_material", "there is no material"},
        Wrong{"edit { remove_material: \"wood\" }", "edit[0].remove_material", "object \"box\" is made of"},
        Wrong{"edit { remove_object: \"box\" } edit { remove_material: \"air\" }", "edit[1].remove_material",
              "object \"ball\" is made of"},
        Wrong{"edit { set_gravity { x: 1e9 } }", "edit[0].set_gravity.x", "permitted"},
        Wrong{"edit { add_finger { name: \"index\" } }", "edit[0].add_finger.name", "already"},
        Wrong{"edit { set_finger { name: \"thumb\" } }", "edit[0].set_finger.name", "there is no finger"},
        Wrong{"edit { set_finger { name: \"index\" device: \"left\" stiffness: -1 point {} } }",
              "edit[0].set_finger.stiffness", "permitted"},
        Wrong{"edit { remove_finger: \"thumb\" }", "edit[0].remove_finger", "there is no finger"},
        // no edit of this object is to blame, so the scene's own field is told
        Wrong{"edit { set_material { name: \"wood\" rigid {} } }", "object[0].dynamic", "needs a mass"}));

TEST(SceneEdit, RefusesNumbersThatAreNotFiniteAndTooManyEdits) {
  v1::EditScene request;
  request.add_edit()->mutable_set_gravity()->set_y(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(error_of([&] { edit_scene(scene(), request); }).field(), "edit[0].set_gravity.y");
  request.mutable_edit(0)->mutable_set_gravity()->set_y(0.0);
  for (int i = 0; i < kMostEdits; ++i) *request.add_edit() = request.edit(0);
  EXPECT_EQ(error_of([&] { edit_scene(scene(), request); }).field(), "edit[4096]");
}

TEST(SceneEdit, SharesTheCellsOfEveryShapeThatRunsAlready) {
  const auto running = build_scene(scene(), default_capacity());
  const auto after = build_edited(edited("edit { set_material { name: \"wood\" density: 700 rigid {} } } "
                                         "edit { move_object { name: \"ball\" } } "
                                         "edit { set_object { object { name: \"box\" shape { box { size { x: "
                                         "0.2 } } } } field: \"shape.box.size.x\" } }"),
                                  {running->message, running->scene}, default_capacity());
  EXPECT_NE(after->scene.objects[0].cells, running->scene.objects[0].cells);
  EXPECT_EQ(after->scene.objects[1].cells, running->scene.objects[1].cells);
  // twice as long, of 700 kg/m^3
  EXPECT_NEAR(after->scene.objects[0].dynamics.mass.mass, 0.2 * 0.1 * 0.1 * 700.0, 1e-9);
}

TEST(SceneEdit, AnObjectFromAMeshFileKeepsItsCellsAndTheFileIsNotReadAgain) {
  const TemporaryFolder folder;
  folder.write("one.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  folder.write("one.ele", "1 4 1\n0 0 1 2 3 5\n");
  const auto file = folder.write("s.scene.txtpb",
                                 "material { name: \"wood\" density: 500 rigid {} }\n"
                                 "object { name: \"m\" shape { mesh { path: \"one.ele\" } } "
                                 "region { tag: 5 material: \"wood\" } dynamic {} }\n");
  const auto running = load_scene(file, default_capacity());
  std::filesystem::remove(folder.path() / "one.ele");
  const auto after =
      build_edited(edit_scene(running->message,
                              request_of("edit { move_object { name: \"m\" pose { position { x: 1 } } } }")),
                   {running->message, running->scene}, default_capacity());
  EXPECT_EQ(after->scene.objects[0].cells, running->scene.objects[0].cells);
  EXPECT_EQ(after->scene.objects[0].dynamics.mass.mass, running->scene.objects[0].dynamics.mass.mass);
  // nor can its path be changed
  EXPECT_EQ(error_of([&] {
              edit_scene(
                  running->message,
                  request_of("edit { set_object { object { name: \"m\" shape { mesh { path: \"x.ele\" } } } "
                             "field: \"shape.mesh.path\" } }"));
            }).field(),
            "edit[0].set_object.object.shape.mesh");
}

}  // namespace
}  // namespace haptic::load
