// What is drawn of a recording.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "client/export/export.h"
#include "client/plot/curves.h"
#include "client/plot/recorded.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/session_recording.h"
#include "tests/support/temporary_folder.h"

namespace haptic::plot {
namespace {

class PlotRecording : public testing::Test {
 protected:
  void write(const std::function<void(recording::SessionWriter&)>& fill) {
    test::write_session(file(), fill);
    source_ = std::make_unique<recording::FileSource>(file());
    recording_ = std::make_unique<recording::Recording>(*source_);
  }

  // the thumb is 1 s in contact and pushes by 1 N, and from then on 2 s by 3 N with 4 N along the surface
  void write_push() {
    write([](recording::SessionWriter& writer) {
      for (std::uint64_t ms = 0; ms < 3000; ++ms) {
        writer.write(ms < 1000 ? test::hips_after(ms, 1.0, 0.0) : test::hips_after(ms, 3.0, 4.0));
      }
    });
  }

  void write_stats() {
    write([](recording::SessionWriter& writer) {
      for (std::uint64_t ms = 0; ms < 300; ms += 100) {
        v1::Frame frame = test::frame_after(ms);
        frame.mutable_stats()->set_tick(frame.tick());
        v1::TransitionStats& transition = *frame.mutable_stats()->add_transition();
        transition.set_before(v1::SUR);
        transition.set_after(v1::EDG);
        transition.set_mean_ns(50.0 + static_cast<double>(ms));
        v1::Histogram& wakeup = *frame.mutable_stats()->mutable_wakeup();
        for (const std::uint64_t upper : {1000U, 2000U}) {
          wakeup.add_upper_ns(upper);
          wakeup.add_count(1);
        }
        wakeup.set_total(2);
        writer.write(frame);
      }
    });
  }

  std::string file() const { return folder_.file("r.mcap"); }

  test::TemporaryFolder folder_;
  std::unique_ptr<recording::FileSource> source_;
  std::unique_ptr<recording::Recording> recording_;
};

TEST_F(PlotRecording, IsToldByWhatItBeginsWith) {
  write_stats();
  EXPECT_TRUE(is_recording(file()));
  EXPECT_FALSE(is_recording(folder_.write("named.mcap", "time,finger\n")));
  EXPECT_FALSE(is_recording(folder_.write("short", "\x89MC")));
  EXPECT_FALSE(is_recording(folder_.file("missing")));
}

TEST_F(PlotRecording, HasTheForceOfAFingerOverTheTimeSinceItsStart) {
  write_push();
  const auto thumb = forces_of(*recording_, Forces::Of::kFingers, {}).by_name.at("thumb");
  ASSERT_EQ(thumb.size(), 3000U);
  EXPECT_EQ(thumb.begin()->first, 0.0);  // though the daemon's tick is its 7000th
  EXPECT_EQ(thumb.begin()->second, (Vector{0.0, 1.0, 0.0}));
  EXPECT_NEAR(thumb.rbegin()->first, 2.999, 1e-12);
  EXPECT_EQ(thumb.rbegin()->second, (Vector{4.0, 3.0, 0.0}));  // of both HIPs
}

TEST_F(PlotRecording, LeavesOutWhatIsBeforeAndFromTheEndOn) {
  write_push();
  const auto thumb =
      forces_of(*recording_, Forces::Of::kFingers, {.from = 0.999, .to = 1.001}).by_name.at("thumb");
  ASSERT_EQ(thumb.size(), 2U);
  EXPECT_NEAR(thumb.begin()->first, 0.999, 1e-12);
  EXPECT_NEAR(thumb.rbegin()->first, 1.0, 1e-12);
}

TEST_F(PlotRecording, HasTheFrictionOfAFinger) {
  write_push();
  const Picture picture =
      friction(forces_of(*recording_, Forces::Of::kFingers, {.from = 0.999, .to = 1.001}), {0.0, 1.0, 0.0});
  EXPECT_EQ(picture.series.at(0).y, (std::vector<double>{0.0, 4.0 / 3.0}));
}

TEST_F(PlotRecording, HasTheHipsAtTheLastTickNotAfterATime) {
  write_push();
  const HipForces last = hip_forces_of(*recording_, std::nullopt);
  EXPECT_NEAR(last.time, 2.999, 1e-12);
  EXPECT_EQ(last.by_finger.at("thumb").at(1.0), (Vector{4.0, 0.0, 0.0}));
  const HipForces early = hip_forces_of(*recording_, 0.9995);
  EXPECT_NEAR(early.time, 0.999, 1e-12);
  EXPECT_EQ(early.by_finger.at("thumb").at(0.0), (Vector{0.0, 1.0, 0.0}));
  EXPECT_EQ(early.by_finger.at("thumb").at(1.0), Vector{});  // it touches nothing yet
  EXPECT_EQ(hip_forces_of(*recording_, 0.0).time, 0.0);
}

TEST_F(PlotRecording, HasHipsThatAreLongBeforeItsEnd) {
  write([](recording::SessionWriter& writer) {
    writer.write(test::hips_after(0, 2.0, 0.0));
    v1::Frame event = test::frame_after(60'000);
    event.mutable_event()->set_message("a minute later");
    writer.write(event);
  });
  EXPECT_EQ(hip_forces_of(*recording_, std::nullopt).by_finger.at("thumb").at(0.0), (Vector{0.0, 2.0, 0.0}));
}

TEST_F(PlotRecording, CountsForcesOfFramesOnceThatOthersOvertook) {
  write([](recording::SessionWriter& writer) {
    v1::Frame stats = test::frame_after(10);  // what comes after it has its log_time until 10 ms
    stats.mutable_stats();
    writer.write(stats);
    for (std::uint64_t ms = 5; ms < 8; ++ms) {
      writer.write(test::hips_after(ms, 1.0, 0.0));
    }
  });
  const auto thumb = forces_of(*recording_, Forces::Of::kFingers, {}).by_name.at("thumb");
  ASSERT_EQ(thumb.size(), 3U);
  EXPECT_NEAR(thumb.begin()->first, 0.005, 1e-12);
  EXPECT_EQ(thumb.begin()->second, (Vector{0.0, 1.0, 0.0}));
}

TEST_F(PlotRecording, HasTheLastStatsWithinATime) {
  write_stats();
  EXPECT_EQ(transitions(stats_of(*recording_, {})).series.at(0).y, std::vector<double>{250.0});
  EXPECT_EQ(transitions(stats_of(*recording_, {.to = 0.2})).series.at(0).y, std::vector<double>{150.0});
  EXPECT_EQ(latency(stats_of(*recording_, {})).series.at(0).y, std::vector<double>{0.5});
  EXPECT_THROW(stats_of(*recording_, {.from = 0.25}), exporting::Missing);
}

TEST_F(PlotRecording, TellsWhatItDoesNotHave) {
  write_stats();
  EXPECT_THROW(forces_of(*recording_, Forces::Of::kFingers, {}), exporting::Missing);
  EXPECT_THROW(hip_forces_of(*recording_, std::nullopt), exporting::Missing);
  EXPECT_THROW(first_of(*recording_), exporting::Missing);
  write_push();
  EXPECT_EQ(first_of(*recording_), Forces::Of::kFingers);
  EXPECT_THROW(stats_of(*recording_, {}), exporting::Missing);
}

TEST_F(PlotRecording, IsDrawnByHapticctl) {
  const std::string out = " " + file() + " -o " + folder_.file("p.svg");
  const auto plot = [&out](const std::string& kind, const std::string& options = "") {
    return test::run_program(test::hapticctl() + " plot " + kind + out + options);
  };
  write_push();
  for (const char* const kind : {"force", "friction", "hips"}) {
    const test::Finished finished = plot(kind);
    EXPECT_EQ(finished.code, 0) << kind << ": " << finished.output;
    EXPECT_TRUE(std::filesystem::remove(folder_.file("p.svg"))) << kind;
  }
  EXPECT_EQ(plot("hips", " --at 500ms").code, 0);
  EXPECT_NE(folder_.read("p.svg").find("Force of each HIP at 0.5 s"), std::string::npos);
  EXPECT_EQ(plot("force", " --topic hips --from 1s --to 2s").code, 0);
  EXPECT_EQ(plot("force", " --topic devices").code, 3);
  EXPECT_EQ(plot("latency").output, "hapticctl: " + file() + ": the recording has no stats\n");
  EXPECT_EQ(plot("force", " --from 2 --to 1").code, 64);
  EXPECT_EQ(plot("force", " --at 1").code, 64);
  EXPECT_EQ(plot("hips", " --from 1").code, 64);
  EXPECT_EQ(plot("friction", " --topic hips").code, 64);
  write_stats();
  for (const char* const kind : {"transitions", "latency"}) {
    EXPECT_EQ(plot(kind).code, 0) << kind;
    EXPECT_TRUE(std::filesystem::remove(folder_.file("p.svg"))) << kind;
  }
}

TEST_F(PlotRecording, IsDrawnAsFarAsItCanBeRead) {
  write_push();
  const std::string bytes = folder_.read("r.mcap");
  folder_.write("r.mcap", bytes.substr(0, bytes.size() * 3 / 4));
  const test::Finished cut =
      test::run_program(test::hapticctl() + " plot force " + file() + " -o " + folder_.file("p.svg"));
  EXPECT_EQ(cut.code, 0);
  EXPECT_NE(cut.output.find("what could be read is drawn"), std::string::npos) << cut.output;
  folder_.write("r.mcap", bytes.substr(0, 8) + "nothing of hapticd");
  EXPECT_EQ(
      test::run_program(test::hapticctl() + " plot force " + file() + " -o " + folder_.file("p.svg")).code,
      3);
}

}  // namespace
}  // namespace haptic::plot
