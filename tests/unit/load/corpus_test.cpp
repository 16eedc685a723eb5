// Every file of the corpora is named for what is wrong with it, or good_*. The wrong ones end in a LoadError
// that says where; none ends in anything else.

#include <algorithm>
#include <vector>

#include "load/config_file.h"
#include "load/mesh_file.h"
#include "load/path_file.h"
#include "load/phantom_calibration.h"
#include "load/scene_file.h"
#include "tests/support/tetgen_pair.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

void load(const std::filesystem::path& file) {
  const std::string kind = file.parent_path().filename();
  if (kind == "scene_fuzz") {
    load_scene(file, default_capacity());
  } else if (kind == "config_fuzz") {
    load_config(file);
  } else if (kind == "calibration_fuzz") {
    load_phantom_calibration(file);
  } else if (kind == "path_fuzz") {
    read_path(file);
  } else if (kind == "gmsh_fuzz") {
    read_mesh(file);
  } else {
    const std::string both = content_of(file);
    const auto [nodes, cells] = test::split_tetgen_pair(both);
    parse_tetgen(nodes, "m.node", cells, "m.ele");
  }
}

std::vector<std::filesystem::path> corpus_files() {
  std::vector<std::filesystem::path> files;
  for (const char* kind :
       {"scene_fuzz", "config_fuzz", "calibration_fuzz", "path_fuzz", "gmsh_fuzz", "tetgen_fuzz"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kSource / "tests/fuzz/corpus" / kind)) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_good(const std::filesystem::path& file) { return file.filename().string().starts_with("good_"); }

class Corpus : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Corpus, IsGoodOrToldWithFileAndPlace) {
  if (is_good(GetParam())) {
    EXPECT_NO_THROW(load(GetParam()));
    return;
  }
  const LoadError error = error_of([] { load(GetParam()); });
  const bool is_binary = error.message().starts_with("byte ");
  const bool is_whole_file = error.message().starts_with("has no first-order tetrahedra");
  // what a calibration lacks as a whole stands nowhere in it
  const bool is_missing = GetParam().parent_path().filename() == "calibration_fuzz" && !error.field().empty();
  EXPECT_FALSE(error.file().empty()) << error.what();
  EXPECT_TRUE(error.line() != 0 || is_binary || is_whole_file || is_missing) << error.what();
  EXPECT_LT(std::string(error.what()).size(), 600U);
}

INSTANTIATE_TEST_SUITE_P(Load, Corpus, testing::ValuesIn(corpus_files()), [](const auto& file) {
  std::string name = file.param.parent_path().filename().string() + "_" + file.param.filename().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.'; }, '_');
  return name;
});

// Text that is cut is nearly always an error, and never anything worse.
class CutText : public testing::TestWithParam<const char*> {};

TEST_P(CutText, IsReadOrRefusedAtEveryByte) {
  const std::string name = GetParam();
  const std::string whole = content_of(kSource / "tests/fuzz/corpus" / name);
  const Syntax syntax = name.ends_with(".json") ? Syntax::kJson : Syntax::kText;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    try {
      if (name.starts_with("scene")) {
        v1::Scene message;
        const TextSource source = parse_message(whole.substr(0, length), "f", syntax, message);
        build_scene(message, source, nullptr, default_capacity());
      } else {
        v1::DaemonConfig message;
        const TextSource source = parse_message(whole.substr(0, length), "f", syntax, message);
        check_config(message, source, "f");
      }
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file(), "f");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Load, CutText,
                         testing::Values("scene_fuzz/good_text.txtpb", "scene_fuzz/good_json.json",
                                         "config_fuzz/good_text.txtpb", "config_fuzz/good_json.json"));

}  // namespace
}  // namespace haptic::load
