#include "load/path_file.h"

#include <cmath>

#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

LoadError error_in(const std::string& text) {
  return error_of([&] { parse_path(text, "p.csv"); });
}

TEST(PathFile, ReadsTimesAndPositions) {
  const auto path = parse_path("time,x,y,z\n0.5,1,-2e-3,3\n1.5,0,0,0\n", "p.csv");
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[0].time, 0.5);
  EXPECT_EQ(path[0].position, glm::dvec3(1.0, -2e-3, 3.0));
  EXPECT_EQ(path[0].orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(PathFile, NormalisesOrientations) {
  const auto path = parse_path("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,0,0,3,4\n", "p.csv");
  EXPECT_EQ(path[0].orientation, glm::dquat(0.0, 0.0, 0.6, 0.8));
}

TEST(PathFile, ReadsNumbersBackExactly) {
  const auto path = parse_path("time,x,y,z\n0.1,0.30000000000000004,1e-308,123456.7890625\n", "p.csv");
  EXPECT_EQ(path[0].time, 0.1);
  EXPECT_EQ(path[0].position, glm::dvec3(0.30000000000000004, 1e-308, 123456.7890625));
}

TEST(PathFile, TellsLineColumnAndNameOfTheField) {
  EXPECT_STREQ(error_in("time,x,y,z\n0,1,2,3\n1,1, abc,3\n").what(),
               "p.csv:3:6: y: \"abc\" is not a finite number");
  EXPECT_STREQ(error_in("time,x,y,z\n0,1,2\n").what(), "p.csv:2:6: z: is missing: the row has 3 of 4 fields");
  EXPECT_EQ(error_in("time,x,y,z\n0,1,2,3\n0,1,2,3\n").field(), "time");
  EXPECT_EQ(error_in("time,x,y,z,qw,qx,qy,qz\n0,1,2,3,0,0,0,0\n").column(), 9U);
}

TEST(PathFile, CutAnywhereIsReadOrRefusedButNeverHalfUnderstood) {
  const std::string whole = "time,x,y,z,qw,qx,qy,qz\n0,10,20,30,1,0,0,0\n12,10,20,30,0,1,0,0\n";
  const auto full = parse_path(whole, "p.csv");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    try {
      const auto path = parse_path(whole.substr(0, length), "p.csv");
      EXPECT_LE(path.size(), full.size());
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file(), "p.csv");
      EXPECT_GT(error.line(), 0U);
    }
  }
}

}  // namespace
}  // namespace haptic::load
