#include "load/text_message.h"

#include "haptic/v1/config.pb.h"
#include "haptic/v1/scene.pb.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

LoadError error_in(const std::string& text, Syntax syntax = Syntax::kText) {
  return error_of([&] {
    v1::Scene scene;
    parse_message(text, "f", syntax, scene);
  });
}

std::string place_of(const std::string& text, const std::string& field, Syntax syntax = Syntax::kText) {
  v1::Scene scene;
  const Place place = parse_message(text, "f", syntax, scene).find(field);
  return std::to_string(place.line) + ":" + std::to_string(place.column);
}

// line 1 is a comment; columns count from 1
const std::string kText =
    "# a scene\n"
    "name: \"s\"\n"
    "object { name: \"a\" }\n"
    "object {\n"
    "  shape { box { size { x: 1  y: 2 } } }\n"
    "}\n";

const std::string kJson =
    "{\n"
    "  \"name\": \"s\",\n"
    "  \"object\": [{\"name\": \"a\"},\n"
    "    {\"shape\":\n"
    "      {\"box\": {\"size\": {\"x\": 1, \"y\": 2}}}, \"airMargin\": 3}]\n"
    "}\n";

TEST(TextMessage, FindsTheLineAndColumnOfAField) {
  EXPECT_EQ(place_of(kText, "name"), "2:1");
  EXPECT_EQ(place_of(kText, "object[0].name"), "3:10");
  EXPECT_EQ(place_of(kText, "object[1]"), "4:1");
  EXPECT_EQ(place_of(kText, "object[1].shape.box.size.y"), "5:30");
}

TEST(TextMessage, FindsTheClosestPlaceOfAFieldThatWasLeftAway) {
  EXPECT_EQ(place_of(kText, "object[1].name"), "4:1");
  EXPECT_EQ(place_of(kText, "object[1].shape.box.size.z"), "5:17");
  EXPECT_EQ(place_of(kText, "gravity.x"), "0:0");
  EXPECT_EQ(place_of(kText, "nonsense[[.]."), "0:0");
}

TEST(TextMessage, FindsTheSameFieldsInJson) {
  EXPECT_EQ(place_of(kJson, "name", Syntax::kJson), "2:3");
  EXPECT_EQ(place_of(kJson, "object[0].name", Syntax::kJson), "3:15");
  EXPECT_EQ(place_of(kJson, "object[1]", Syntax::kJson), "4:5");
  EXPECT_EQ(place_of(kJson, "object[1].shape.box.size.y", Syntax::kJson), "5:33");
  EXPECT_EQ(place_of(kJson, "object[1].shape.box.size.z", Syntax::kJson), "5:16");
  EXPECT_EQ(place_of(kJson, "object[1].air_margin", Syntax::kJson), "5:44");
}

TEST(TextMessage, TellsAnUnknownField) {
  const LoadError text = error_in("name: \"a\"\n  nme: 3\n");
  EXPECT_EQ(text.line(), 2U);
  EXPECT_NE(text.message().find("no field named \"nme\""), std::string::npos);
  const LoadError json = error_in("{\"object\": [\n{\"nme\": 3}]}", Syntax::kJson);
  EXPECT_STREQ(json.what(), "f:2:2: object[0]: haptic.v1.Object has no field named \"nme\"");
}

TEST(TextMessage, TellsANumberThatIsNotFinite) {
  const LoadError text = error_in("gravity {\n y: -inf }");
  EXPECT_STREQ(text.what(), "f:2:2: gravity.y: is not a finite number");
  EXPECT_EQ(error_in("gravity { x: 1e999 }").field(), "gravity.x");
  EXPECT_EQ(error_in("{\"gravity\": {\"x\": \"NaN\"}}", Syntax::kJson).field(), "gravity.x");
  EXPECT_EQ(error_in("finger { points { hip {} hip { z: nan } } }").field(), "finger[0].points.hip[1].z");
}

TEST(TextMessage, TellsAFieldThatIsGivenTwice) {
  EXPECT_EQ(error_in("name: \"a\"\nname: \"b\"").line(), 2U);
  EXPECT_EQ(error_in("{\"name\": \"a\",\n\"name\": \"b\"}", Syntax::kJson).line(), 2U);
}

TEST(TextMessage, RefusesTextThatNoClientCouldRead) {
  // the two bytes of an overlong /, a surrogate, and the first code point beyond Unicode
  for (const char* text :
       {"\\xc0\\xaf", "\\xed\\xa0\\x80", "\\xf4\\x90\\x80\\x80", "\\xff", "\\x80", "a\\n"}) {
    EXPECT_EQ(error_in(std::string("name: \"") + text + "\"").field(), "name") << text;
  }
  v1::Scene scene;
  parse_message("name: \"\u00fc\u20ac\U0001F600\"", "f", Syntax::kText, scene);
  EXPECT_EQ(scene.name(), "\u00fc\u20ac\U0001F600");
}

TEST(TextMessage, RefusesTextThatIsVeryLong) {
  EXPECT_EQ(error_in("name: \"" + std::string(4097, 'x') + "\"").field(), "name");
  v1::Scene scene;
  EXPECT_NO_THROW(parse_message("name: \"" + std::string(4096, 'x') + "\"", "f", Syntax::kText, scene));
}

TEST(TextMessage, RefusesAnEnumeratorThatDoesNotExistEvenAsANumber) {
  v1::DaemonConfig config;
  const std::string text = "listen { unix { path: \"s\" allow { group: \"g\" role: 77 } } }";
  EXPECT_EQ(error_of([&] { parse_message(text, "f", Syntax::kText, config); }).field(),
            "listen[0].unix.allow[0].role");
}

TEST(TextMessage, OfAMessageFromMemoryNamesTheFieldAlone) {
  const LoadError error = error_of([] { TextSource().fail("object[2].name", "is bad"); });
  EXPECT_STREQ(error.what(), "object[2].name: is bad");
  EXPECT_EQ(error.line(), 0U);
}

TEST(TextMessage, ChoosesJsonByTheNameOfTheFile) {
  const TemporaryFolder folder;
  v1::Scene scene;
  read_message(folder.write("a.json", kJson), scene);
  EXPECT_EQ(scene.object_size(), 2);
  read_message(folder.write("a.txtpb", kText), scene);
  EXPECT_EQ(scene.object(1).shape().box().size().y(), 2.0);
  EXPECT_EQ(error_of([&] { read_message(folder.write("b.txtpb", kJson), scene); }).line(), 1U);
}

}  // namespace
}  // namespace haptic::load
