#include "load/check.h"

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <sstream>

#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

struct Result {
  int code;
  std::string out, err;
};

Result run(const CheckOptions& options) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = check(options, out, err);
  return {code, out.str(), err.str()};
}

google::protobuf::Struct json_of(const std::string& text) {
  google::protobuf::Struct json;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(text, &json).ok()) << text;
  return json;
}

const std::string kGrasp = (kSource / "config/grasp.txtpb").string();

TEST(Check, TellsWhatWasUnderstood) {
  const Result result = run({kGrasp, "", false});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
  for (const char* part : {"device     left: simulated, path of 7 rows to 5 s",
                           "object     box: moves, 0.036", "released after 0.6 s", "12 surface triangles",
                           "finger     thumb on device left: 11 HIPs of 100 N/m"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
}

TEST(Check, TellsTheSameAsJson) {
  const Result result = run({kGrasp, "", true});
  EXPECT_EQ(result.code, 0);
  auto json = json_of(result.out);
  const auto& scene = json.fields().at("scene").struct_value().fields();
  EXPECT_EQ(scene.at("hips").number_value(), 22.0);
  const auto& box = scene.at("objects").list_value().values(0).struct_value().fields();
  EXPECT_EQ(box.at("name").string_value(), "box");
  EXPECT_EQ(box.at("surface_triangles").number_value(), 12.0);
  EXPECT_EQ(box.at("bytes_per_cell").number_value(),
            box.at("bytes").number_value() / box.at("cells").number_value());
  // a cuboid of mass m: m (y^2 + z^2) / 12 about x, the smallest
  const auto& inertia = box.at("inertia").list_value();
  const double smallest = std::min(
      {inertia.values(0).number_value(), inertia.values(1).number_value(), inertia.values(2).number_value()});
  EXPECT_NEAR(smallest, 0.036 * (0.03 * 0.03 + 0.03 * 0.03) / 12.0, 1e-15);
  EXPECT_EQ(json.fields().at("warnings").list_value().values_size(), 0);
}

TEST(Check, OfABadFileFailsAndNamesThePlace) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("s.scene.txtpb", "name: \"s\"\ngravity { x: inf }\n").string();
  const Result text = run({"", scene, false});
  EXPECT_EQ(text.code, 1);
  EXPECT_EQ(text.out, "");
  EXPECT_EQ(text.err, "hapticd check: " + scene + ":2:11: gravity.x: is not a finite number\n");
  const Result json = run({"", scene, true});
  EXPECT_EQ(json.code, 1);
  const auto message = json_of(json.out);
  const auto& error = message.fields().at("error").struct_value().fields();
  EXPECT_EQ(error.at("line").number_value(), 2.0);
  EXPECT_EQ(error.at("field").string_value(), "gravity.x");
}

TEST(Check, TellsOfEachFileOfTlsWhatIsWrongWithItAndWhere) {
  const TemporaryFolder folder;
  const std::string config =
      folder
          .write(
              "c.txtpb",
              "listen { tcp { address: \"127.0.0.1\" port: 7411 allow { name: \"a\" role: OBSERVE }\n"
              "  tls {\n    certificate: \"s.crt\"\n    key: \"s.key\"\n    authority: \"a.crt\"\n  } } }\n")
          .string();
  CheckOptions options{config, "", false};
  EXPECT_EQ(run(options).code, 0);
  options.tls_problems = [&](const v1::Listen::Tls& tls) {
    EXPECT_EQ(tls.key(), (folder.path() / "s.key").string());  // whole, so that it can be opened
    return std::vector<TlsProblem>{{"key", "it is bent"}, {"authority", "nobody knows it"}};
  };
  const Result text = run(options);
  EXPECT_EQ(text.code, 1);
  EXPECT_EQ(text.out, "");
  EXPECT_EQ(text.err, "hapticd check: " + config + ":4:5: listen[0].tcp.tls.key: it is bent\n" +
                          "hapticd check: " + config +
                          ":5:5: listen[0].tcp.tls.authority: nobody knows it\n");
  options.json = true;
  const auto message = json_of(run(options).out);
  EXPECT_EQ(message.fields().at("error").struct_value().fields().at("line").number_value(), 4.0);
  EXPECT_EQ(message.fields().at("errors").list_value().values_size(), 2);
}

TEST(Check, OfNothingIsAnErrorOfUsage) { EXPECT_EQ(run({"", "", false}).code, 64); }

TEST(Check, WarnsOfWhatIsHardlyMeant) {
  const TemporaryFolder folder;
  // the hand starts at the origin, in the middle of the box
  const std::string config =
      folder
          .write(
              "c.txtpb",
              "device { name: \"d\" simulated { mass: 1 } } device { name: \"idle\" simulated { mass: 1 } }")
          .string();
  const std::string scene =
      folder
          .write("s.scene.txtpb",
                 "material { name: \"wood\" density: 1 rigid {} } material { name: \"air\" free {} }"
                 "object { name: \"a\" shape { box { size { x: 0.01 y: 0.01 z: 0.01 } } } inside: \"wood\" "
                 "outside: \"air\" dynamic {} }"
                 "finger { name: \"f\" device: \"d\" stiffness: 100 point {} }"
                 "finger { name: \"g\" device: \"gone\" stiffness: 100 point {} }")
          .string();
  const Result result = run({config, scene, false});
  EXPECT_EQ(result.code, 0);
  // 1e-6 kg at 1000 Hz bears less than 4 * 1e-6 * 1e6 = 4 N/m
  for (const char* part :
       {"object[0].outside: is not used", "finger[1].device: no device of the config is named \"gone\"",
        "device[1]: no finger rides on \"idle\"", "finger[0]: 1 of its HIPs start inside rigid material",
        "object[0]: is so light that it may shake: all HIPs together have 200 N/m"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
}

}  // namespace
}  // namespace haptic::load
