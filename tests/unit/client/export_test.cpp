// Tables of what a recording holds.

#include "client/export/export.h"

#include <gtest/gtest.h>

#include <functional>

#include "proto/recording/error.h"
#include "tests/support/session_recording.h"
#include "tests/support/temporary_folder.h"

namespace haptic::exporting {
namespace {

class Export : public testing::Test {
 protected:
  std::string csv_of(Topic topic, const std::function<void(recording::SessionWriter&)>& fill) {
    test::write_session(folder_.file("r.mcap"), fill);
    const recording::FileSource source(folder_.file("r.mcap"));
    const recording::Recording recording(source);
    export_tables(recording, {.topics = {topic}, .file = folder_.file("t.csv"), .format = Format::kCsv});
    return folder_.read("t.csv");
  }

  // what is wrong with the frame; the file that was to hold it is not there then
  std::string problem_of(Topic topic, const v1::Frame& frame) {
    try {
      csv_of(topic, [&frame](recording::SessionWriter& writer) { writer.write(frame); });
    } catch (const recording::FormatError& error) {
      EXPECT_FALSE(std::filesystem::exists(folder_.file("t.csv")));
      EXPECT_FALSE(std::filesystem::exists(folder_.file("t.csv.part")));
      return error.what();
    }
    return "nothing";
  }

  test::TemporaryFolder folder_;
};

TEST_F(Export, TellsTheTickOfAFrameWhoseListsDoNotFitTogether) {
  v1::Frame hips = test::hips_after(0, 1.0, 2.0);
  hips.mutable_hips()->add_force(1.0);
  EXPECT_EQ(problem_of(Topic::kHips, hips),
            "the frame of tick 7000 has a list of 7 numbers, which is no multiple of 3");
  hips.mutable_hips()->add_force(1.0);
  hips.mutable_hips()->add_force(1.0);
  EXPECT_EQ(problem_of(Topic::kHips, hips),
            "the frame of tick 7000 has lists of 2 and of 3 items for the same things");

  v1::Frame contacts = test::hips_after(3, 1.0, 2.0);
  contacts.mutable_hips()->mutable_contact_state()->RemoveLast();
  EXPECT_EQ(problem_of(Topic::kContacts, contacts),
            "the frame of tick 7003 has lists of 2 and of 1 items for the same things");

  v1::Frame selected = test::hips_after(0, 1.0, 2.0);
  selected.mutable_hips()->add_hip(1);
  EXPECT_EQ(problem_of(Topic::kHips, selected),
            "the frame of tick 7000 has lists of 2 and of 1 items for the same things");

  v1::Frame objects = test::frame_after(0);
  for (int i = 0; i < 3; ++i) objects.mutable_objects()->add_position(0.0);
  EXPECT_EQ(problem_of(Topic::kObjects, objects),
            "the frame of tick 7000 has lists of 1 and of 0 items for the same things");

  v1::Frame devices = test::frame_after(0);
  devices.mutable_devices()->add_present(true);
  EXPECT_EQ(problem_of(Topic::kDevices, devices),
            "the frame of tick 7000 has lists of 0 and of 1 items for the same things");
}

TEST_F(Export, ReadsBackEvents) {
  const std::string table = csv_of(Topic::kEvents, [](recording::SessionWriter& writer) {
    v1::Frame armed = test::frame_after(0);
    armed.mutable_event()->set_kind(v1::Event::ARMED);
    armed.mutable_event()->set_message("armed by \"alice\", user 1000");
    writer.write(armed);
    v1::Frame fault = test::frame_after(250);
    fault.mutable_event()->set_kind(v1::Event::FAULT_LATCHED);
    fault.mutable_event()->mutable_fault()->set_kind(v1::FAULT_OVER_SPEED);
    fault.mutable_event()->mutable_fault()->set_device("left");
    writer.write(fault);
    v1::Frame scene = test::frame_after(500);
    scene.mutable_event()->set_kind(v1::Event::SCENE_CHANGED);
    scene.mutable_event()->set_scene_revision(2);
    writer.write(scene);
  });
  EXPECT_EQ(table,
            "tick,time,kind,fault,device,scene_revision,message\n"
            "7000,7,armed,,,0,\"armed by \"\"alice\"\", user 1000\"\n"
            "7250,7.25,fault_latched,over_speed,left,0,\n"
            "7500,7.5,scene_changed,,,2,\n");
}

TEST_F(Export, ReadsBackStatsARowForEachStage) {
  const std::string table = csv_of(Topic::kStats, [](recording::SessionWriter& writer) {
    v1::Frame frame = test::frame_after(0);
    v1::Stats& stats = *frame.mutable_stats();
    stats.set_missed_ticks(3);
    stats.set_lost_snapshots(4);
    stats.mutable_wakeup()->set_total(5);
    stats.mutable_wakeup()->set_mean_ns(1.5);
    v1::Histogram& step = *stats.add_stage();
    step.set_name("step");
    step.set_total(6);
    step.set_mean_ns(0.1);
    step.set_p50_ns(7);
    step.set_p99_ns(8);
    step.set_p999_ns(9);
    step.set_max_ns(18446744073709551615U);
    writer.write(frame);
  });
  EXPECT_EQ(table,
            "tick,time,missed_ticks,lost_snapshots,stage,count,mean_ns,p50_ns,p99_ns,p999_ns,max_ns\n"
            "7000,7,3,4,wake-up,5,1.5,0,0,0,0\n"
            "7000,7,3,4,step,6,0.1,7,8,9,18446744073709551615\n");
}

TEST_F(Export, ReadsBackGaps) {
  const std::string table = csv_of(Topic::kGaps, [](recording::SessionWriter& writer) {
    v1::Gap gap;
    gap.set_first_sequence(11);
    gap.set_last_sequence(13);
    gap.set_first_tick(7010);
    gap.set_last_tick(7012);
    writer.write(gap, test::kRecordingStart + 1'000'000);
  });
  EXPECT_EQ(table, "first_tick,last_tick,frames\n7010,7012,3\n");
}

}  // namespace
}  // namespace haptic::exporting
