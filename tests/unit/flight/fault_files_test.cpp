#include "flight/fault_files.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <set>

#include "proto/recording/error.h"
#include "proto/recording/recording.h"
#include "tests/support/temporary_folder.h"

namespace haptic::flight {
namespace {

// 2026-11-21 16:23:19.123 UTC: `date -u -d '2026-11-21 16:23:19' +%s`
constexpr std::uint64_t kTime = 1'795'278'199'123'456'789;
constexpr std::uint64_t kSecond = 1'000'000'000;

Excerpt some_excerpt() {
  Excerpt excerpt;
  excerpt.session.program = "test";
  return excerpt;
}

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

std::string error_of(const std::string& folder) {
  try {
    save(some_excerpt(), folder, 20, "over_speed", kTime);
  } catch (const recording::IoError& error) {
    return error.what();
  }
  return "";
}

TEST(FaultFiles, AreNamedByTheFaultAndWhenItWas) {
  const test::TemporaryFolder folder;
  const std::string path = save(some_excerpt(), folder.file(""), 20, "over_speed", kTime);
  EXPECT_EQ(names_in(folder.file("")), std::set<std::string>{"fault-20261121T162319.123Z-over_speed.mcap"});
  const recording::FileSource source(path);
  EXPECT_EQ(recording::Recording(source).damage(), "");
}

TEST(FaultFiles, OfTheSameMillisecondDoNotReplaceEachOther) {
  const test::TemporaryFolder folder;
  EXPECT_NE(save(some_excerpt(), folder.file(""), 20, "over_speed", kTime),
            save(some_excerpt(), folder.file(""), 20, "over_speed", kTime));
  EXPECT_EQ(names_in(folder.file("")).size(), 2U);
}

TEST(FaultFiles, OnlyTheNewestStayAndNothingElseIsTouched) {
  const test::TemporaryFolder folder;
  folder.write("notes.txt", "mine");
  folder.write("fault-of-mine.mcap", "mine");
  for (std::uint64_t i = 0; i < 5; ++i) {
    save(some_excerpt(), folder.file(""), 2, "lost_device", kTime + i * kSecond);
  }
  EXPECT_EQ(
      names_in(folder.file("")),
      (std::set<std::string>{"notes.txt", "fault-of-mine.mcap", "fault-20261121T162322.123Z-lost_device.mcap",
                             "fault-20261121T162323.123Z-lost_device.mcap"}));
}

TEST(FaultFiles, TheOneJustWrittenStaysWhereTheClockWasSetBack) {
  const test::TemporaryFolder folder;
  save(some_excerpt(), folder.file(""), 2, "over_speed", kTime + 10 * kSecond);
  save(some_excerpt(), folder.file(""), 2, "over_speed", kTime + 20 * kSecond);
  const std::string path = save(some_excerpt(), folder.file(""), 2, "over_speed", kTime);
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_EQ(names_in(folder.file("")).size(), 2U);
}

TEST(FaultFiles, TheFolderIsMadeIfOnlyItselfIsMissing) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(error_of(folder.file("faults")), "");
  EXPECT_EQ(names_in(folder.file("faults")).size(), 1U);
  EXPECT_EQ(error_of(folder.file("no/faults")),
            folder.file("no/faults") + ": cannot be made: No such file or directory");
  EXPECT_EQ(error_of(folder.write("file", "")), folder.file("file") + ": is no directory");
}

TEST(FaultFiles, NoPartIsLeftWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  // a limit for files is what a full disk is to whoever writes
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 100, .rlim_max = before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of(folder.file(""));
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(error, "");
  EXPECT_TRUE(names_in(folder.file("")).empty());
}

TEST(FaultFiles, GoWhereTheServiceManagerSaysUnlessTheConfigDoes) {
  v1::FlightRecorder config;
  ::unsetenv("LOGS_DIRECTORY");
  EXPECT_EQ(directory_of(config), "");
  ::setenv("LOGS_DIRECTORY", "/var/log/hapticd:/var/log/other", 1);
  EXPECT_EQ(directory_of(config), "/var/log/hapticd/faults");
  config.set_directory("/srv/faults");
  EXPECT_EQ(directory_of(config), "/srv/faults");
  ::unsetenv("LOGS_DIRECTORY");
}

}  // namespace
}  // namespace haptic::flight
