// What the arguments of the editing verbs say to the daemon.

#include "client/cli/edit.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "client/lib/error.h"

namespace haptic::cli {
namespace {

template <typename Message>
using AddOptions = void (*)(CLI::App&, Changes<Message>&, Editing);

// the changes that the arguments ask for; throws CLI::ParseError
template <typename Message>
Changes<Message> parse(AddOptions<Message> add_options, const std::string& arguments, Editing editing) {
  CLI::App app("", "hapticctl");
  CLI::App* verb = app.add_subcommand("verb");
  Changes<Message> changes;
  add_options(*verb, changes, editing);
  app.parse("verb " + arguments);
  return changes;
}

v1::Object object(const std::string& arguments) {
  return parse(add_object_options, arguments, Editing::kAdd).applied_to({});
}
v1::Material material(const std::string& arguments) {
  return parse(add_material_options, arguments, Editing::kAdd).applied_to({});
}
v1::Finger finger(const std::string& arguments) {
  return parse(add_finger_options, arguments, Editing::kAdd).applied_to({});
}

template <typename Message>
std::string text(const Message& message) {
  google::protobuf::TextFormat::Printer printer;
  printer.SetSingleLineMode(true);
  std::string line;
  printer.PrintToString(message, &line);
  return line.empty() ? line : line.substr(0, line.size() - 1);
}

TEST(ObjectAdd, SaysAllThatIsTold) {
  EXPECT_EQ(
      text(object("box1 --box 0.08 0.03 0.03 --inside wood --outside air --air-margin 0.02 --at 0 -0.05 0 "
                  "--turn 1 0 0 0 --dynamic --linear-viscosity 0.8 --release-after 2")),
      "name: \"box1\" shape { box { size { x: 0.08 y: 0.03 z: 0.03 } } } inside: \"wood\" outside: \"air\" "
      "air_margin: 0.02 pose { position { y: -0.05 } orientation { w: 1 } } "
      "dynamic { linear_viscosity: 0.8 release_after: 2 }");
}

TEST(ObjectAdd, MakesTheOtherShapes) {
  EXPECT_EQ(text(object("ball --sphere 0.1 --subdivisions 2").shape()),
            "icosphere { radius: 0.1 subdivisions: 2 }");
  EXPECT_EQ(text(object("ball --sphere 0.1").shape()), "icosphere { radius: 0.1 subdivisions: 3 }");
  EXPECT_EQ(text(object("can --cylinder 0.1 0.2 --segments 8").shape()),
            "cylinder { radius: 0.1 height: 0.2 segments: 8 }");
}

TEST(ObjectAdd, TakesAMessageAndChangesItWithOptions) {
  EXPECT_EQ(
      text(object("--message 'name: \"a\" inside: \"wood\" pose { position { x: 1 } orientation { w: 1 } }' "
                  "--inside stone --at 2 0 0")),
      "name: \"a\" inside: \"stone\" pose { position { x: 2 } orientation { w: 1 } }");
}

TEST(ObjectAdd, RefusesWhatDoesNotGoTogether) {
  for (const char* wrong : {"", "a --box 1 2", "a --box 1 2 x", "a --box 1 2 inf", "a --box 1 1 1 --sphere 1",
                            "a --subdivisions 2", "a --message 'nonsense'", "a --file /nowhere", "a --at 1 2",
                            "a --fixed", "a b"}) {
    EXPECT_THROW(object(wrong), CLI::ParseError) << wrong;
  }
}

TEST(ObjectSet, NamesEachFieldThatItSetsOnce) {
  const v1::SceneEdit edit = set_object_edit(
      parse(add_object_options, "box1 --linear-viscosity 1 --inside stone --sphere 0.5 --subdivisions 2",
            Editing::kSet));
  EXPECT_EQ(text(edit),
            "set_object { object { name: \"box1\" shape { icosphere { radius: 0.5 subdivisions: 2 } } "
            "inside: \"stone\" "
            "dynamic { linear_viscosity: 1 } } "
            "field: \"shape\" field: \"inside\" field: \"dynamic.linear_viscosity\" }");
}

TEST(ObjectSet, NamesTheFieldsOfAMessage) {
  const v1::SceneEdit edit = set_object_edit(parse(
      add_object_options, "box1 --message 'air_margin: 1 dynamic { release_after: 2 }'", Editing::kSet));
  EXPECT_EQ(text(edit),
            "set_object { object { name: \"box1\" air_margin: 1 dynamic { release_after: 2 } } "
            "field: \"air_margin\" field: \"dynamic.release_after\" }");
}

TEST(ObjectSet, FixesAnObjectByTellingThatNothingMovesIt) {
  EXPECT_EQ(text(set_object_edit(parse(add_object_options, "box1 --fixed", Editing::kSet))),
            "set_object { object { name: \"box1\" } field: \"dynamic\" }");
}

TEST(ObjectSet, NeedsSomethingToSet) {
  EXPECT_THROW(parse(add_object_options, "box1", Editing::kSet), CLI::ParseError);
}

TEST(MaterialAdd, SaysHowAProxyMovesInIt) {
  EXPECT_EQ(text(material("wood --density 500 --rigid 1 0.5")),
            "name: \"wood\" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 }");
  EXPECT_EQ(text(material("air --free")), "name: \"air\" free { }");
  EXPECT_EQ(text(material("clay --yielding 2 --drag 3 --friction 1 0.5")),
            "name: \"clay\" yielding { force: 2 drag: 3 static_friction: 1 kinetic_friction: 0.5 }");
  EXPECT_EQ(text(material("honey --viscous 4")), "name: \"honey\" viscous { drag: 4 }");
  EXPECT_THROW(material("wood --free --viscous 1"), CLI::ParseError);
  EXPECT_THROW(material("wood --drag 1"), CLI::ParseError);
}

TEST(MaterialSet, LeavesWhatIsNotTold) {
  v1::Scene scene;
  *scene.add_material() = material("wood --density 500 --rigid 1 0.5");
  const v1::SceneEdit edit =
      set_material_edit(scene, parse(add_material_options, "wood --density 700", Editing::kSet));
  EXPECT_EQ(text(edit.set_material()),
            "name: \"wood\" density: 700 rigid { static_friction: 1 kinetic_friction: 0.5 }");
  EXPECT_THROW(set_material_edit(scene, parse(add_material_options, "clay --free", Editing::kSet)),
               client::NotFound);
}

TEST(FingerAdd, SaysWhereItsHipsAre) {
  EXPECT_EQ(
      text(finger("thumb --device left --stiffness 100 --fingertip 0.008 0.5 --direction 0 0 1 --hips 11")),
      "name: \"thumb\" device: \"left\" stiffness: 100 fingertip { radius: 0.008 cap_angle: 0.5 hips: 11 "
      "direction { z: 1 } }");
  EXPECT_EQ(text(finger("probe --point")), "name: \"probe\" point { }");
  EXPECT_EQ(text(finger("edge --line 0 0 0 0.1 0 0 --hips 5")),
            "name: \"edge\" line { start { } end { x: 0.1 } hips: 5 }");
  EXPECT_THROW(finger("probe --point --hips 3"), CLI::ParseError);
  EXPECT_THROW(finger("probe --direction 0 0 1"), CLI::ParseError);
}

TEST(FingerSet, LeavesWhatIsNotTold) {
  v1::Scene scene;
  *scene.add_finger() = finger("thumb --device left --stiffness 100 --point");
  const v1::SceneEdit edit =
      set_finger_edit(scene, parse(add_finger_options, "thumb --stiffness 200", Editing::kSet));
  EXPECT_EQ(text(edit.set_finger()), "name: \"thumb\" device: \"left\" stiffness: 200 point { }");
}

}  // namespace
}  // namespace haptic::cli
