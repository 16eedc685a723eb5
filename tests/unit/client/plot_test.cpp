#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "client/lib/error.h"
#include "client/plot/curves.h"
#include "client/plot/forces.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace haptic::plot {
namespace {

Csv csv(const std::string& text) {
  std::istringstream stream(text);
  return Csv::parse(stream, "t.csv");
}

Forces all_of(const Csv& table) { return forces_of(table, first_of(table)); }

std::string error_of(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const client::Error& error) {
    return error.what();
  }
  return "no error";
}

// two HIPs of "a" on one tick, then one alone; HIP 1 held by two objects at once
const char* const kHips =
    "tick,time,finger,hip,object,force_x,force_y,force_z\n"
    "0,0,a,0,o,0,3,0\n"
    "0,0,a,1,o,0,1,0\n"
    "0,0,a,1,p,3,0,0\n"
    "1,0.001,a,0,o,0,0,0\n"
    "1,0.001,a,1,o,1,-2,2\n";

TEST(Csv, ReadsQuotedFieldsAndBothLineEnds) {
  const Csv table = csv("a,\"b,\"\"c\"\"\"\r\n1,\"x\ny\"\n\"2\",\n");
  ASSERT_EQ(table.rows(), 2U);
  const std::size_t second = table.column("b,\"c\"");
  EXPECT_EQ(table.text(0, second), "x\ny");
  EXPECT_EQ(table.text(1, second), "");
  EXPECT_EQ(table.number(1, table.column("a")), 2.0);
}

TEST(Csv, TellsFileLineAndColumnOfWhatIsWrong) {
  EXPECT_EQ(error_of([] { csv(""); }), "t.csv:1: there is no header");
  EXPECT_EQ(error_of([] { csv("a,b\n1,2\n3\n"); }), "t.csv:3: the row has 1 fields, the header 2");
  EXPECT_EQ(error_of([] { csv("a\n\"1\n2\n"); }), "t.csv:2: a quote is not closed");
  EXPECT_EQ(error_of([] { csv("a\n").column("b"); }), "t.csv:1: there is no column \"b\"");
  EXPECT_EQ(error_of([] { csv("a\n1\n\"2\n\"\nx\n").number(2, 0); }),
            "t.csv:5: \"x\" in column \"a\" is no number");
  for (const char* const bad : {"", "nan", "inf", "1e999", "1 ", "0x1", "1,5"}) {
    const std::string cell = std::string("\"") + bad + "\"";
    EXPECT_NE(error_of([&cell] { csv("a\n" + cell + "\n").number(0, 0); }), "no error") << bad;
  }
  EXPECT_EQ(error_of([] { Csv::read("/nowhere.csv"); }), "/nowhere.csv: cannot be read");
}

TEST(Csv, RefusesFieldsAndRowsWithoutEnd) {
  EXPECT_EQ(error_of([] { csv(std::string(5000, 'x')); }), "t.csv:1: a field is longer than 4096 bytes");
  EXPECT_EQ(error_of([] { csv(std::string(300, ',')); }), "t.csv:1: a row has more than 256 fields");
}

TEST(Curves, AddTheForcesOfAFingersHips) {
  const Picture picture = force(all_of(csv(kHips)));
  ASSERT_EQ(picture.series.size(), 1U);
  EXPECT_EQ(picture.series[0].name, "a");
  EXPECT_EQ(picture.series[0].x, (std::vector<double>{0.0, 0.001}));
  EXPECT_EQ(picture.series[0].y, (std::vector<double>{5.0, 3.0}));  // |(3, 4, 0)|, |(1, -2, 2)|
}

TEST(Curves, TakeDevicesAndObjectsAsWell) {
  EXPECT_EQ(force(all_of(csv("time,device,fx,fy,fz\n0,left,0,0,-2\n"))).series[0].y,
            std::vector<double>{2.0});
  EXPECT_EQ(force(all_of(csv("time,object,fx,fy,fz\n0,box,0,6,8\n"))).series[0].name, "box");
  EXPECT_EQ(error_of([] { force(all_of(csv("time,hand,fx,fy,fz\n"))); }),
            "t.csv:1: there is no column \"object\"");
}

TEST(Curves, DivideTangentialByNormalForce) {
  const Picture picture = friction(all_of(csv(kHips)), {0.0, 1.0, 0.0});
  EXPECT_DOUBLE_EQ(picture.series[0].y[0], 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(picture.series[0].y[1], std::sqrt(5.0) / 2.0);
  // nothing presses along z at first
  EXPECT_TRUE(std::isnan(friction(all_of(csv(kHips)), {0.0, 0.0, 1.0}).series[0].y[0]));
}

TEST(Curves, LeaveOutWhatIsBeforeAndFromTheEndOn) {
  const Csv table = csv(kHips);
  EXPECT_EQ(force(forces_of(table, Forces::Of::kFingers, {.from = 0.001})).series[0].y,
            std::vector<double>{3.0});
  EXPECT_EQ(force(forces_of(table, Forces::Of::kFingers, {.to = 0.001})).series[0].y,
            std::vector<double>{5.0});
}

TEST(Curves, HaveFrictionOfFingersOnly) {
  EXPECT_EQ(error_of([] { forces_of(csv("time,device,fx,fy,fz\n"), Forces::Of::kFingers); }),
            "t.csv:1: there is no column \"finger\"");
}

TEST(Curves, ShowEachHipAtTheTickThatIsAskedFor) {
  const Picture last = hips(hip_forces_of(csv(kHips), std::nullopt));
  EXPECT_EQ(last.series[0].x, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(last.series[0].y, (std::vector<double>{0.0, 3.0}));
  const Picture first = hips(hip_forces_of(csv(kHips), 0.0009));
  EXPECT_EQ(first.series[0].y, (std::vector<double>{3.0, std::sqrt(10.0)}));
}

TEST(Curves, TellTheShareOfTicksAboveEachBound) {
  v1::Stats stats;
  v1::Histogram& wakeup = *stats.mutable_wakeup();
  for (const std::uint64_t upper : {1000U, 2000U, 4000U}) {
    wakeup.add_upper_ns(upper);
  }
  for (const std::uint64_t count : {6U, 3U, 1U}) {
    wakeup.add_count(count);
  }
  wakeup.set_total(10);
  const Picture picture = latency(stats);
  ASSERT_EQ(picture.series.size(), 1U);
  EXPECT_EQ(picture.series[0].x, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(picture.series[0].y, (std::vector<double>{0.4, 0.1}));  // none above the last
}

TEST(Curves, NameEachTransitionThatWasTimed) {
  v1::Stats stats;
  v1::TransitionStats& one = *stats.add_transition();
  one.set_before(v1::SUR);
  one.set_after(v1::EDG);
  one.set_mean_ns(70.0);
  stats.add_transition()->set_count(5);  // counted only
  const Picture picture = transitions(stats);
  EXPECT_EQ(picture.labels, std::vector<std::string>{"Sur to Edg"});
  EXPECT_EQ(picture.series[0].y, std::vector<double>{70.0});
}

TEST(Thinned, KeepsTheLeastAndTheGreatestValue) {
  Series saw;
  for (int i = 0; i < 10'000; ++i) {
    saw.x.push_back(i);
    saw.y.push_back(i == 4321 ? 9.0 : i == 8765 ? -9.0 : i % 2);
  }
  const Series thin = thinned(saw, 100);
  EXPECT_LE(thin.x.size(), 100U);
  EXPECT_TRUE(std::is_sorted(thin.x.begin(), thin.x.end()));
  EXPECT_EQ(
      thin.y[static_cast<std::size_t>(std::find(thin.x.begin(), thin.x.end(), 4321.0) - thin.x.begin())],
      9.0);
  EXPECT_EQ(*std::min_element(thin.y.begin(), thin.y.end()), -9.0);
  EXPECT_EQ(thinned(saw, 100'000).x, saw.x);
}

class Drawing : public testing::Test {
 protected:
  static Picture line(const std::string& name) {
    Picture picture;
    picture.series.push_back({.name = name, .x = {0.0, 1.0, 2.0, 3.0}, .y = {1.0, NAN, 2.0, 3.0}});
    return picture;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Drawing, TakesNamesForWhatTheyAre) {
  const std::string evil = "it's \"`date`\" $x\n' ; system 'touch " + folder_.file("touched") + "' #";
  Picture picture = line(evil);
  picture.title = evil;
  draw(picture, folder_.file("a.svg"), {});
  EXPECT_FALSE(std::filesystem::exists(folder_.file("touched")));
  EXPECT_NE(folder_.read("a.svg").find("it's"), std::string::npos);
}

TEST_F(Drawing, WritesSvgAndPng) {
  draw(line("a"), folder_.file("a.svg"), {.width = 300, .height = 200});
  const std::string svg = folder_.read("a.svg");
  EXPECT_NE(svg.find("width=\"300\" height=\"200\""), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  draw(line("a"), folder_.file("a.png"), {});
  EXPECT_EQ(folder_.read("a.png").substr(1, 3), "PNG");
}

TEST_F(Drawing, TellsWhatCannotBeDrawnOrWritten) {
  EXPECT_EQ(error_of([this] { draw(line("a"), folder_.file("a.pdf"), {}); }),
            folder_.file("a.pdf") + ": a picture's name ends in .svg or .png");
  EXPECT_EQ(error_of([this] { draw(Picture(), folder_.file("a.svg"), {}); }), "there is nothing to draw");
  EXPECT_EQ(error_of([] { draw(line("a"), "/nowhere/a.svg", {}); }),
            "/nowhere/a.svg: No such file or directory");
  // a logarithm has no room for what is below zero
  Picture picture = line("a");
  picture.log_y = true;
  picture.series[0].y = {-1.0, -2.0, -3.0, -4.0};
  const std::string error = error_of([&] { draw(picture, folder_.file("a.svg"), {}); });
  EXPECT_EQ(error.substr(0, 9), "gnuplot: ") << error;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("a.svg")));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("a.svg.part")));
}

TEST_F(Drawing, IsAVerbOfHapticctl) {
  const std::string input = folder_.write("hips.csv", kHips);
  const std::string picture = folder_.file("p.svg");
  const std::string plot = test::hapticctl() + " plot ";
  for (const char* const kind : {"force", "friction", "hips --at 0"}) {
    const test::Finished finished = test::run_program(plot + kind + " " + input + " -o " + picture);
    EXPECT_EQ(finished.code, 0) << kind << ": " << finished.output;
    EXPECT_TRUE(std::filesystem::remove(picture)) << kind;
  }
  const std::string stats = folder_.write(
      "stats.json",
      R"({"tick":"9","wakeup":{"upper_ns":["10","20"],"count":["1","1"],"total":"2"},)"
      R"("transition":[{"before":"TET","after":"SUR","count":"3","mean_ns":55}],"of_later_versions":1})");
  for (const char* const kind : {"transitions", "latency"}) {
    const test::Finished finished = test::run_program(plot + kind + " " + stats + " -o " + picture);
    EXPECT_EQ(finished.code, 0) << kind << ": " << finished.output;
    EXPECT_TRUE(std::filesystem::remove(picture)) << kind;
  }
  EXPECT_EQ(test::run_program(plot + "weather " + input + " -o " + picture).code, 64);
  EXPECT_EQ(test::run_program(plot + "friction " + input + " --normal 0 0 0 -o " + picture).code, 1);
  EXPECT_EQ(test::run_program(plot + "latency " + input + " -o " + picture).code, 1);
  const test::Finished without =
      test::run_program("PATH=/nowhere " + plot + "force " + input + " -o " + picture);
  EXPECT_EQ(without.code, 1);
  EXPECT_EQ(without.output, "hapticctl: there is no gnuplot; Debian's package is gnuplot-nox\n");
}

}  // namespace
}  // namespace haptic::plot
