#include "simulate/simulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include "load/error.h"
#include "simulate/replay_file.h"
#include "tests/support/temporary_folder.h"

namespace haptic::simulate {
namespace {

constexpr const char* kHipHeader =
    "tick,time,finger,hip,object,state,slipping,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,"
    "force_z";

// A point is pressed 10 mm into the top of a rigid block and drawn back; 100 N/m make 1 N of it.
class Simulate : public ::testing::Test {
 protected:
  using Row = std::vector<std::string>;

  Simulate() {
    folder_.write("press.csv", "time,x,y,z\n0,0,0.03,0\n1,0,0.01,0\n");
    write_config("");
    folder_.write("block.scene.txtpb", R"(
      material { name: "air" free {} }
      material { name: "stone" rigid {} }
      object {
        name: "block"
        shape { box { size { x: 0.1 y: 0.04 z: 0.1 } } }
        inside: "stone" outside: "air" air_margin: 0.005
      }
      finger { name: "tip" device: "probe" stiffness: 100 point {} }
    )");
    options_.config = folder_.file("config.txtpb");
    options_.scene = folder_.file("block.scene.txtpb");
    options_.csv = {.hips = folder_.file("hips.csv"),
                    .objects = folder_.file("objects.csv"),
                    .devices = folder_.file("devices.csv")};
  }

  void write_config(const std::string& safety, double rate = 1000.0) {
    folder_.write("config.txtpb", "servo { rate_hz: " + std::to_string(rate) +
                                      " }\n"
                                      "device { name: \"probe\" playback { path: \"press.csv\" } }\n"
                                      "safety { max_force_rate: 1e6 " +
                                      safety + " }\n");
  }

  std::string run(double duration) {
    options_.duration = duration;
    std::ostringstream summary;
    simulate(options_, summary);
    return summary.str();
  }

  /// The rows of a file without its header. Names in these tests have no commas.
  std::vector<Row> rows(const std::string& name) {
    std::istringstream lines(folder_.read(name));
    std::vector<Row> all;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      Row& row = all.emplace_back(1);
      for (const char c : line) {
        if (c == ',')
          row.emplace_back();
        else
          row.back().push_back(c);
      }
    }
    return all;
  }

  test::TemporaryFolder folder_;
  SimulateOptions options_;
};

TEST_F(Simulate, RunsEveryTickUpToTheDuration) {
  run(0.01);
  const std::vector<Row> devices = rows("devices.csv");
  ASSERT_EQ(devices.size(), 11u) << "ticks 0 to 10";
  for (std::size_t tick = 0; tick < devices.size(); ++tick) {
    EXPECT_EQ(devices[tick][0], std::to_string(tick));
    EXPECT_EQ(std::stod(devices[tick][1]), static_cast<double>(tick) / 1000.0);
  }
}

TEST_F(Simulate, RefusesADeviceThatIsHardwareAndTellsWhere) {
  folder_.write("config.txtpb", "servo { rate_hz: 1000 }\ndevice { name: \"hand\" falcon {} }\n");
  try {
    run(0.01);
    FAIL() << "no exception";
  } catch (const load::LoadError& error) {
    EXPECT_EQ(error.line(), 2u);
    EXPECT_NE(error.message().find("virtual clock"), std::string::npos) << error.what();
  }
}

TEST_F(Simulate, ADurationOfZeroIsOneTick) {
  run(0.0);
  EXPECT_EQ(rows("devices.csv").size(), 1u);
}

TEST_F(Simulate, TicksFollowTheRateOfTheConfig) {
  write_config("", 3000.0);
  run(1.0);
  const std::vector<Row> devices = rows("devices.csv");
  ASSERT_EQ(devices.size(), 3001u);
  EXPECT_EQ(std::stod(devices[1][1]), 1.0 / 3000.0);
  EXPECT_EQ(std::stod(devices[3000][1]), 1.0);
}

TEST_F(Simulate, WritesTheHeadersThatAreAgreed) {
  run(0.0);
  const auto header = [&](const char* name) {
    const std::string text = folder_.read(name);
    return text.substr(0, text.find('\n'));
  };
  EXPECT_EQ(header("hips.csv"), kHipHeader);
  EXPECT_EQ(header("objects.csv"), "tick,time,object,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,fx,fy,fz,tx,ty,tz");
  EXPECT_EQ(header("devices.csv"), "tick,time,device,x,y,z,qw,qx,qy,qz,fx,fy,fz,tx,ty,tz,armed,fault");
}

TEST_F(Simulate, AHipThatNothingHoldsHasARowWithoutAnObject) {
  run(0.0);
  const std::vector<Row> hips = rows("hips.csv");
  ASSERT_EQ(hips.size(), 1u);
  const Row expected = {"0",    "0", "tip", "0",    "",  "Out", "0", "0",
                        "0.03", "0", "0",   "0.03", "0", "0",   "0", "0"};
  EXPECT_EQ(hips[0], expected);
}

// At 1 s the HIP is 10 mm below the top of the block, at 0.02 m, where its proxy stays: 100 N/m x 10 mm.
TEST_F(Simulate, AHipPressedIntoAnObjectHasItsProxyOnTheSurface) {
  run(1.0);
  const Row last = rows("hips.csv").back();
  EXPECT_EQ(last[4], "block");
  EXPECT_NE(last[5], "Out");
  EXPECT_NEAR(std::stod(last[8]), 0.01, 1e-12);
  EXPECT_NEAR(std::stod(last[11]), 0.02, 1e-9);
  EXPECT_NEAR(std::stod(last[14]), 1.0, 1e-6);
  const Row object = rows("objects.csv").back();
  EXPECT_EQ(object[2], "block");
  EXPECT_NEAR(std::stod(object[17]), -1.0, 1e-6);
}

TEST_F(Simulate, ForcesAreArmedFromTheStartAndOnlyTheDevicesFileIsBehindTheGuard) {
  write_config("max_force: 0.25");
  run(1.0);
  EXPECT_NEAR(std::stod(rows("hips.csv").back()[14]), 1.0, 1e-6);
  const std::vector<Row> devices = rows("devices.csv");
  EXPECT_NEAR(std::stod(devices.back()[11]), 0.25, 1e-12);
  for (const Row& row : devices) {
    EXPECT_EQ(row[16], "1");
    EXPECT_EQ(row[17], "");
  }
}

TEST_F(Simulate, AFaultIsNamedInTheDevicesFileAndInTheSummary) {
  write_config("max_speed: 0.01");  // the probe goes at 0.02 m/s
  const std::string summary = run(0.01);
  const Row first = rows("devices.csv").front();
  EXPECT_EQ(first[16], "0");
  EXPECT_EQ(first[17], "over_speed");
  EXPECT_NE(summary.find("over_speed of probe: 0.02, allowed 0.01"), std::string::npos) << summary;
}

TEST_F(Simulate, TwoRunsWriteTheSameBytes) {
  run(1.0);
  std::map<std::string, std::string> first;
  for (const char* name : {"hips.csv", "objects.csv", "devices.csv"}) first[name] = folder_.read(name);
  options_.verbose = true;  // what is timed changes nothing
  run(1.0);
  for (const auto& [name, text] : first) EXPECT_EQ(folder_.read(name), text) << name;
}

TEST_F(Simulate, TheSummaryTellsTheTicksAndOnRequestTheTransitions) {
  EXPECT_EQ(run(0.5).rfind("501 ticks", 0), 0u);
  EXPECT_EQ(run(0.5).find("Out -> Out"), std::string::npos);
  options_.verbose = true;
  EXPECT_NE(run(0.5).find("Out -> Out"), std::string::npos);
}

TEST_F(Simulate, WithoutASceneThereIsNothingToFeel) {
  options_.scene.clear();
  run(0.01);
  EXPECT_TRUE(rows("hips.csv").empty());
  EXPECT_EQ(rows("devices.csv").size(), 11u);
}

TEST_F(Simulate, AFileThatCannotBeWrittenIsAnError) {
  options_.csv.objects = folder_.file("no/such/folder.csv");
  EXPECT_THROW(run(0.01), csv::OutputError);
  options_.csv.objects = "/dev/full";
  EXPECT_THROW(run(0.01), csv::OutputError);
}

TEST_F(Simulate, AConfigThatIsNotThereIsAnError) {
  options_.config = folder_.file("none.txtpb");
  EXPECT_THROW(run(0.01), load::LoadError);
}

TEST_F(Simulate, RefusesADeviceThatLivesInRealTime) {
  folder_.write("config.txtpb", "device { name: \"probe\" virtual {} }\n");
  try {
    run(0.01);
    FAIL() << "no exception";
  } catch (const load::LoadError& error) {
    EXPECT_EQ(error.field(), "device[0]");
    EXPECT_EQ(error.message(), "lives in real time: it cannot follow a virtual clock");
  }
}

// 10 mm deep after half a second of 100 N/m: 1 N; then the device is gone.
TEST_F(Simulate, ADeviceHasTheLimitsAndTheWorkspaceOfItsConfig) {
  folder_.write(
      "config.txtpb",
      "servo { rate_hz: 1000 }\n"
      "device {\n"
      "  name: \"probe\" simulated { mass: 0.1 hand { stiffness: 300 damping: 3 path: \"press.csv\" } }\n"
      "  workspace { scale: 2 force_scale: 0.5 }\n"
      "  limits { max_force: 0.1 travel { min { x: -1 y: 0.005 z: -1 } max { x: 1 y: 0.029 z: 1 } } }\n"
      "}\n");
  // the hand begins at 0.03 m, which is beyond 0.029 m
  EXPECT_NE(run(0.01).find("fault at 0 s: over_travel of probe: 0.03, allowed 0.029"), std::string::npos);
  folder_.write(
      "config.txtpb",
      "servo { rate_hz: 1000 }\n"
      "device {\n"
      "  name: \"probe\" simulated { mass: 0.1 hand { stiffness: 300 damping: 3 path: \"press.csv\" } }\n"
      "  workspace { scale: 0.7 force_scale: 0.5 }\n"
      "  limits { max_force: 0.1 }\n"
      "}\n");
  EXPECT_EQ(run(2.0).find("fault"), std::string::npos);
  const std::vector<Row> devices = rows("devices.csv");
  EXPECT_NEAR(std::stod(devices[0][4]), 0.7 * 0.03, 1e-12);
  // about 0.7 * 0.01 m, which is 13 mm deep: 1.3 N in the world, 0.65 N on the hand but for its limit
  EXPECT_NEAR(std::stod(devices.back()[11]), 0.1, 1e-12);
}

// What is recorded as the input of a tick is what lies behind the workspace, so that a replay, which has
// none, comes to the same state.
TEST_F(Simulate, ARunWithAWorkspaceReplaysToTheBit) {
  folder_.write(
      "config.txtpb",
      "device {\n"
      "  name: \"probe\" simulated { mass: 0.1 hand { stiffness: 300 damping: 3 path: \"press.csv\" } }\n"
      "  workspace { scale: 0.9 force_scale: 0.7 filter { kind: ADAPTIVE_WINDOW } }\n"
      "}\n");
  options_.recording = folder_.file("run.mcap");
  run(1.0);
  std::ostringstream told;
  EXPECT_TRUE(replay({.file = options_.recording}, told)) << told.str();
  EXPECT_NE(told.str().find("1000 ticks"), std::string::npos) << told.str();
}

TEST_F(Simulate, TellsTheFaultThatWasInjected) {
  folder_.write("config.txtpb",
                "device { name: \"probe\" simulated { mass: 0.1 damping: 1\n"
                "  hand { stiffness: 300 damping: 6 path: \"press.csv\" }\n"
                "  fault { kind: UNPLUG at: 0.7 } } }\n");
  EXPECT_NE(run(1.0).find("fault at 0.72 s: stale_sample of probe: 0.021, allowed 0.02; forces are zero"),
            std::string::npos)
      << run(1.0);
}

}  // namespace
}  // namespace haptic::simulate
