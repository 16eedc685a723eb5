#include "proto/csv/csv_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <random>

#include "tests/support/temporary_folder.h"

namespace haptic::csv {
namespace {

TEST(CsvFile, WritesAHeaderAndRows) {
  const test::TemporaryFolder folder;
  CsvFile csv(folder.file("a.csv"), "n,flag,name,x,y,z,qw,qx,qy,qz");
  csv.add(std::uint64_t{7}).add(true).add("box").add(glm::dvec3(0.5, -1.0, 0.0));
  csv.add(glm::dquat(1.0, 0.25, 0.0, 0.0)).end_row();
  csv.close();
  EXPECT_EQ(folder.read("a.csv"),
            "n,flag,name,x,y,z,qw,qx,qy,qz\n"
            "7,1,box,0.5,-1,0,1,0.25,0,0\n");
}

TEST(CsvFile, AnEmptyFieldAtTheEndOfARowStaysOne) {
  const test::TemporaryFolder folder;
  CsvFile csv(folder.file("a.csv"), "a,b");
  csv.add(false).add("").end_row();
  csv.close();
  EXPECT_EQ(folder.read("a.csv"), "a,b\n0,\n");
}

TEST(CsvFile, QuotesNamesThatWouldBreakARow) {
  const test::TemporaryFolder folder;
  CsvFile csv(folder.file("a.csv"), "name");
  csv.add("a,b").end_row();
  csv.add("say \"so\"").end_row();
  csv.close();
  EXPECT_EQ(folder.read("a.csv"), "name\n\"a,b\"\n\"say \"\"so\"\"\"\n");
}

TEST(CsvFile, NumbersReadBackAsTheSameBits) {
  const test::TemporaryFolder folder;
  std::mt19937_64 random(3);
  std::vector<double> values = {0.0, -0.0, 0.1, 1e-310, 1.7976931348623157e308, 1.0 / 3.0};
  while (values.size() < 1000) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  CsvFile csv(folder.file("a.csv"), "x");
  for (const double value : values) csv.add(value).end_row();
  csv.close();
  std::istringstream lines(folder.read("a.csv"));
  std::string line;
  std::getline(lines, line);
  for (const double value : values) {
    std::getline(lines, line);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(line.c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value))
        << line;
  }
}

TEST(CsvFile, KeepsEveryRowOfALargeFile) {
  const test::TemporaryFolder folder;
  constexpr std::uint64_t kRows = 400000;  // several buffers
  CsvFile csv(folder.file("a.csv"), "n");
  std::size_t bytes = 2;
  for (std::uint64_t i = 0; i < kRows; ++i) {
    csv.add(i).end_row();
    bytes += std::to_string(i).size() + 1;
  }
  csv.close();
  EXPECT_EQ(folder.read("a.csv").size(), bytes);
}

TEST(CsvFile, AFolderThatDoesNotExistIsAnErrorThatNamesTheFile) {
  try {
    const CsvFile csv("/does/not/exist.csv", "x");
    FAIL() << "no exception";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("/does/not/exist.csv"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
}

TEST(CsvFile, AFullDiskIsAnError) {
  CsvFile csv("/dev/full", "x");
  csv.add(1.0).end_row();
  EXPECT_THROW(csv.close(), OutputError);
}

TEST(CsvFile, AFullDiskIsNoticedBeforeTheEnd) {
  CsvFile csv("/dev/full", "x");
  EXPECT_THROW(for (int i = 0; i < 10'000'000; ++i) csv.add(1.0).end_row();, OutputError);
}

}  // namespace
}  // namespace haptic::csv
