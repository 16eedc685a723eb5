#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <filesystem>

#include "log/begin_log.h"
#include "tests/support/temporary_folder.h"

namespace haptic::log {
namespace {

v1::Log config_for(const std::string& file) {
  v1::Log config;
  config.set_level(v1::Log::INFO);
  config.set_file(file);
  config.set_file_bytes(4096);
  return config;
}

TEST(LogFile, HasEachLineWithItsTimeAndLevel) {
  const test::TemporaryFolder folder;
  begin_log(config_for(folder.file("hapticd.log")), true);
  spdlog::warn("of interest");
  spdlog::debug("of none");
  const std::string text = folder.read("hapticd.log");
  EXPECT_NE(text.find(" warning of interest\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("of none"), std::string::npos) << text;
}

TEST(LogFile, KeepsThreeOldOnesBesideTheNewestAndAllAreSmall) {
  const test::TemporaryFolder folder;
  begin_log(config_for(folder.file("hapticd.log")), true);
  for (char c = 'a'; c <= 'z'; ++c) spdlog::info(std::string(1500, c));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file(""))) {
    ++files;
    EXPECT_LE(entry.file_size(), 4096U) << entry.path();
  }
  EXPECT_EQ(files, 4U);
  EXPECT_NE(folder.read("hapticd.log").find("zzz"), std::string::npos);
}

TEST(LogFile, ThatCannotBeWrittenIsToldByTheFieldOfTheConfig) {
  const test::TemporaryFolder folder;
  try {
    begin_log(config_for(folder.write("file", "") + "/hapticd.log"), true);
    FAIL() << "it is written";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("log.file: "), 0U) << error.what();
  }
}

}  // namespace
}  // namespace haptic::log
