// The files that are shipped, and those that the manual shows, load as they stand.

#include <algorithm>
#include <vector>

#include "load/config_file.h"
#include "load/phantom_calibration.h"
#include "load/scene_file.h"
#include "load/scene_report.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

std::vector<std::filesystem::path> files_of(const std::string& folder, bool scenes) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / folder)) {
    const std::string name = entry.path().filename();
    if (name.ends_with(".txtpb") && name.ends_with(".scene.txtpb") == scenes) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  EXPECT_FALSE(files.empty());
  return files;
}

TEST(ShippedFiles, EveryConfigLoadsWithItsSceneAndWithoutAWarning) {
  std::vector<std::filesystem::path> files = files_of("config", false);
  for (const auto& file : files_of("config/devices", false)) files.push_back(file);
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const LoadedConfig config = load_config(file);
    ASSERT_FALSE(config.message.scene().empty());
    const auto scene = load_scene(config.message.scene(), config.message.capacity());
    EXPECT_EQ(report_scene(*scene, &config).warnings, std::vector<std::string>{});
  }
}

TEST(ShippedFiles, EveryCalibrationLoadsAndGivesNoForceAsItStands) {
  for (const auto& file : files_of("config/calibrations", false)) {
    SCOPED_TRACE(file);
    EXPECT_EQ(load_phantom_calibration(file).max_force(), 0.0);
  }
}

TEST(ShippedFiles, EverySceneLoads) {
  for (const auto& file : files_of("config/scenes", true)) {
    SCOPED_TRACE(file);
    EXPECT_FALSE(load_scene(file, default_capacity())->scene.objects.empty());
  }
}

TEST(ShippedFiles, TheExamplesLoadAsTheyStand) {
  for (const auto& file : files_of("tests/data/examples", true)) {
    SCOPED_TRACE(file);
    EXPECT_EQ(load_scene(file, default_capacity())->scene.objects.size(), 1U);
  }
  for (const auto& file : files_of("tests/data/examples", false)) {
    SCOPED_TRACE(file);
    EXPECT_FALSE(load_config(file).paths[0].empty());
  }
}

TEST(ShippedFiles, ThePressScenesHaveTheTrianglesOfThePaper) {
  for (const char* kind : {"geometric", "yield"}) {
    for (const std::size_t triangles : {80U, 320U}) {
      const std::string name = std::string("press_") + kind + "_" + std::to_string(triangles);
      const auto scene = load_scene(kSource / "config/scenes" / (name + ".scene.txtpb"), default_capacity());
      EXPECT_EQ(scene->scene.name, name);
      EXPECT_EQ(scene->scene.hip_count, 50U);
      EXPECT_EQ(report_scene(*scene, nullptr).objects[0].surface_triangles, triangles);
    }
  }
}

TEST(ShippedFiles, TheGraspIsThatOfThePaper) {
  const LoadedConfig config = load_config(kSource / "config/grasp.txtpb");
  const auto loaded = load_scene(config.message.scene(), config.message.capacity());
  EXPECT_EQ(loaded->scene.hip_count, 22U);
  // 500 kg/m^3 * 0.08 * 0.03 * 0.03 m^3
  EXPECT_NEAR(loaded->scene.objects[0].dynamics.mass.mass, 0.036, 1e-15);
}

}  // namespace
}  // namespace haptic::load
