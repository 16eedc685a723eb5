// From what clients ask for to scenes that can run: what is built anew, what is taken over, and what is said
// where something is wrong.

#include "daemon/scene_builder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <utility>

#include "client/cli/scene_text.h"
#include "load/config_file.h"
#include "load/text_message.h"
#include "tests/support/temporary_folder.h"

namespace haptic {
namespace {

const char* const kScene = R"(
  material { name: "wood" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 } }
  material { name: "stone" density: 2500 rigid { static_friction: 0.6 kinetic_friction: 0.4 } }
  material { name: "air" free {} }
  object { name: "box" shape { box { size { x: 0.1 y: 0.1 z: 0.1 } } } inside: "wood" dynamic {} }
  object { name: "wall" shape { box { size { x: 1 y: 1 z: 0.1 } } } inside: "wood" }
  finger { name: "index" device: "left" stiffness: 100 point {} }
)";

// a tetrahedron of 1 m, whose one cell is tagged 5
const char* const kMeshScene = R"(
  material { name: "wood" density: 500 rigid {} }
  object { name: "m" shape { mesh { path: "meshes/one.ele" } } region { tag: 5 material: "wood" } dynamic {} }
)";

void write_mesh(const test::TemporaryFolder& folder) {
  std::filesystem::create_directory(folder.file("meshes"));
  folder.write("meshes/one.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  folder.write("meshes/one.ele", "1 4 1\n0 0 1 2 3 5\n");
}

template <class Message>
Message parsed(const std::string& text) {
  Message message;
  load::parse_message(text, "", load::Syntax::kText, message);
  return message;
}

class Building : public testing::Test {
 protected:
  Building() { run(builder_.from_request(parsed<v1::LoadScene>(std::string("scene {") + kScene + "}"))); }

  void run(ipc::BuiltScene built) {
    const std::shared_ptr<const servo::PreparedScene> kept(std::move(built.prepared));
    running_ = {.message = built.description.scene(),
                .scene = std::shared_ptr<const engine::Scene>(kept, &kept->world.scene()),
                .revision = 7};
  }
  ipc::BuiltScene edit(const std::string& edits) const {
    return builder_.from_edit(parsed<v1::EditScene>(edits), running_);
  }
  ipc::BuiltScene set(const std::string& object, const std::string& fields) const {
    return edit("edit { set_object { object { " + object + " } " + fields + " } }");
  }
  // "field: message"
  std::string refusal(const std::function<void()>& action) const {
    try {
      action();
    } catch (const ipc::SceneError& error) {
      EXPECT_EQ(error.wire.code(), v1::Error::INVALID);
      return error.wire.field() + ": " + error.wire.message();
    }
    return "no refusal";
  }

  SceneBuilder builder_{load::default_capacity(), {"left"}};
  ipc::RunningScene running_;
};

TEST_F(Building, AnEditIsForTheRevisionThatItWasMadeOf) {
  const ipc::BuiltScene built = edit("edit { set_gravity { z: -9.81 } }");
  ASSERT_TRUE(built.prepared->carry);
  EXPECT_EQ(built.prepared->carry->from_revision, 7U);
  EXPECT_EQ(built.prepared->world.scene().gravity.z, -9.81);
  EXPECT_EQ(built.description.scene().gravity().z(), -9.81);
}

TEST_F(Building, AnEditTakesOverWhatItLeavesAlone) {
  const ipc::BuiltScene built = edit("edit { remove_object: \"box\" }");
  const engine::Scene& scene = built.prepared->world.scene();
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].cells, running_.scene->objects[1].cells);
  ASSERT_EQ(built.prepared->carry->map.objects.size(), 1U);
  EXPECT_EQ(built.prepared->carry->map.objects[0].from, 1);
  EXPECT_EQ(built.prepared->carry->map.fingers, std::vector<engine::Index>{0});
  EXPECT_EQ(built.prepared->device_of_finger, std::vector<std::uint32_t>{0});
}

TEST_F(Building, AnEditIsDescribedAsWhatWasMadeOfIt) {
  const ipc::BuiltScene built = set(R"(name: "box" inside: "stone")", R"(field: "inside")");
  ASSERT_EQ(built.description.object_size(), 2);
  EXPECT_EQ(built.description.object(0).name(), "box");
  EXPECT_NEAR(built.description.object(0).mass(), 0.1 * 0.1 * 0.1 * 2500.0, 1e-9);
  EXPECT_EQ(built.description.object(1).mass(), 0.0);
  EXPECT_EQ(built.description.finger(0).hips(), 1U);
  EXPECT_EQ(built.description.scene().object(0).inside(), "stone");
}

TEST_F(Building, AnEditThatIsWrongIsRefusedByItsFieldAndChangesNothing) {
  const std::string before = running_.message.SerializeAsString();
  EXPECT_EQ(refusal([&] {
              edit(R"(edit { set_gravity {} } edit { remove_object: "nobody" })");
            }).rfind("edit[1].remove_object: ", 0),
            0U);
  EXPECT_EQ(running_.message.SerializeAsString(), before);
}

TEST_F(Building, SetsWhatAnObjectIsMadeOf) {
  const ipc::BuiltScene built = set(R"(name: "box" inside: "stone")", R"(field: "inside")");
  const engine::Scene& scene = built.prepared->world.scene();
  EXPECT_EQ(scene.objects[0].materials[0].static_friction, 0.6);
  EXPECT_EQ(scene.objects[0].cells, running_.scene->objects[0].cells);  // the shape is the same
  EXPECT_EQ(refusal([&] {
              set(R"(name: "box" inside: "cheese")", R"(field: "inside")");
            }).rfind("edit[0].set_object.object.inside: ", 0),
            0U);
}

TEST_F(Building, SetsHowAnObjectMoves) {
  const ipc::BuiltScene built = set(R"(name: "box" dynamic { linear_viscosity: 0.8 release_after: 2 })",
                                    R"(field: "dynamic.linear_viscosity" field: "dynamic.release_after")");
  const engine::Object& box = built.prepared->world.scene().objects[0];
  EXPECT_TRUE(box.dynamic);
  EXPECT_EQ(box.dynamics.linear_viscosity, 0.8);
  EXPECT_EQ(box.release_after, 2.0);
  // the wall becomes loose, the box fixed
  EXPECT_TRUE(
      set(R"(name: "wall" dynamic {})", R"(field: "dynamic")").prepared->world.scene().objects[1].dynamic);
  EXPECT_FALSE(set(R"(name: "box")", R"(field: "dynamic")").prepared->world.scene().objects[0].dynamic);
  EXPECT_EQ(refusal([&] {
              set(R"(name: "box" dynamic { linear_viscosity: -1 })", R"(field: "dynamic.linear_viscosity")");
            }).rfind("edit[0].set_object.object.dynamic.linear_viscosity: ", 0),
            0U);
}

TEST_F(Building, SetsWhereAnObjectIsWhichThenComesFromNowhere) {
  const ipc::BuiltScene built =
      set(R"(name: "box" pose { position { y: 0.5 } })", R"(field: "pose.position.y")");
  EXPECT_EQ(built.prepared->world.scene().objects[0].initial_pose.position.y, 0.5);
  EXPECT_EQ(built.prepared->carry->map.objects[0].from, engine::kNone);
  EXPECT_EQ(refusal([&] {
              set(R"(name: "box" pose { position { y: 1e9 } })", R"(field: "pose.position.y")");
            }).rfind("edit[0].set_object.object.pose.position.y: ", 0),
            0U);
}

TEST_F(Building, SetsTheShapeOfAnObjectAsAWholeOrInPart) {
  const ipc::BuiltScene longer =
      set(R"(name: "box" shape { box { size { x: 0.2 } } })", R"(field: "shape.box.size.x")");
  EXPECT_NEAR(longer.prepared->world.scene().objects[0].dynamics.mass.mass, 0.2 * 0.1 * 0.1 * 500.0, 1e-9);
  const ipc::BuiltScene ball =
      set(R"(name: "box" shape { icosphere { radius: 0.1 subdivisions: 1 } })", R"(field: "shape")");
  EXPECT_TRUE(ball.description.scene().object(0).shape().has_icosphere());
  // a margin of air needs a material outside
  const ipc::BuiltScene airy =
      set(R"(name: "box" outside: "air" air_margin: 0.02)", R"(field: "outside" field: "air_margin")");
  EXPECT_GT(airy.description.object(0).cells(), running_.scene->objects[0].cells->cells().size());
}

TEST_F(Building, RefusesFieldsThatCannotBeSet) {
  for (const auto& [fields, place] :
       {std::pair{R"(field: "shape.box.size.x")", "edit[0].set_object.object.shape.box.size.x: "},
        {R"(field: "shape.ball")", "edit[0].set_object.field[0]: "},
        {R"(field: "inside" field: "colour")", "edit[0].set_object.field[1]: "},
        {"", "edit[0].set_object.field: "}}) {
    const std::string said = refusal([&, fields = fields] {
      set(R"(name: "box" inside: "wood" shape { box { size { x: -1 } } })", fields);
    });
    EXPECT_EQ(said.rfind(place, 0), 0U) << said;
  }
  EXPECT_EQ(refusal([&] {
              set(R"(name: "box" shape { mesh { path: "/etc/passwd" } })", R"(field: "shape")");
            }).rfind("edit[0].set_object.object.shape.mesh", 0),
            0U);
}

class MeshScene : public testing::Test {
 protected:
  MeshScene() {
    write_mesh(folder_);
    file_ = folder_.write("m.scene.txtpb", kMeshScene);
  }

  test::TemporaryFolder folder_;
  std::string file_;
  SceneBuilder builder_{load::default_capacity(), {}};
};

TEST_F(MeshScene, CanBeSavedElsewhereAndLoadedThere) {
  // as a daemon that was started with a relative path
  const std::string here = std::filesystem::proximate(file_).string();
  ASSERT_NE(here, file_);
  const ipc::BuiltScene built = builder_.from_file(here);
  EXPECT_EQ(built.description.scene().object(0).shape().mesh().path(), folder_.file("meshes/one.ele"));

  const test::TemporaryFolder elsewhere;
  for (const char* name : {"saved.scene.txtpb", "saved.scene.json"}) {
    cli::write_scene_text(built.description.scene(), elsewhere.file(name), false);
    const ipc::BuiltScene again = builder_.from_file(elsewhere.file(name));
    EXPECT_EQ(again.description.SerializeAsString(), built.description.SerializeAsString());
    EXPECT_EQ(again.description.object(0).cells(), 1U);
  }
}

TEST_F(MeshScene, CanBeEditedWithoutItsFile) {
  ipc::BuiltScene built = builder_.from_file(file_);
  std::filesystem::remove_all(folder_.file("meshes"));
  const std::shared_ptr<const servo::PreparedScene> kept(std::move(built.prepared));
  const ipc::RunningScene running = {
      .message = built.description.scene(),
      .scene = std::shared_ptr<const engine::Scene>(kept, &kept->world.scene()),
      .revision = 1};
  const ipc::BuiltScene edited = builder_.from_edit(
      parsed<v1::EditScene>(R"(edit { move_object { name: "m" pose { position { x: 1 } } } })"), running);
  EXPECT_EQ(edited.prepared->world.scene().objects[0].cells, running.scene->objects[0].cells);
}

}  // namespace
}  // namespace haptic
