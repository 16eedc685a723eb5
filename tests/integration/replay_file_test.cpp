// A recording that one build made, kept in tests/data/recordings, is replayed by this one, whatever its
// compiler: the engine's bits are the same on each.

#include "simulate/replay_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <set>
#include <sstream>

#include "haptic/v1/control.pb.h"
#include "proto/recording/recording.h"
#include "proto/recording/session.h"
#include "proto/recording/writer.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace haptic::simulate {
namespace {

const std::string kKept = test::source_dir() + "/tests/data/recordings/edited.mcap";

using Change = std::function<bool(const std::string& topic, std::string& data)>;  // false: leave it away

/// The recording with its messages changed.
std::string copy_of(const std::string& name, const test::TemporaryFolder& folder, const Change& change) {
  const recording::FileSource source(kKept);
  const recording::Recording kept(source);
  const std::string path = folder.file(name);
  recording::FileSink sink(path, recording::FileSink::IfThere::kReplace, recording::FileSink::Durable::kNo);
  recording::Writer writer(sink, {.library = "test"});
  for (const auto& [id, schema] : kept.schemas()) writer.add(schema);
  for (const auto& [id, channel] : kept.channels()) writer.add(channel);
  for (auto messages = kept.messages(); messages.next();) {
    recording::Message message = messages.message();
    std::string data(message.data);
    if (!change(messages.channel().topic, data)) continue;
    message.data = data;
    writer.write(message);
  }
  writer.close();
  sink.close();
  return path;
}

/// Changes frames with inputs.
Change of_inputs(const std::function<bool(v1::Frame&)>& change) {
  return [change](const std::string& topic, std::string& data) {
    if (topic != recording::channel_of(v1::INPUTS)) return true;
    v1::Frame frame;
    frame.ParseFromString(data);
    const bool keep = change(frame);
    data = frame.SerializeAsString();
    return keep;
  };
}

struct Outcome {
  bool same;
  std::string text;
};

Outcome run(const std::string& file, bool json = false) {
  std::ostringstream out;
  const bool same = replay({.file = file, .json = json}, out);
  return {same, out.str()};
}

// where the recording tells the HIPs, too
constexpr std::uint64_t kDecimation = 20;

/// A tick in the middle.
std::uint64_t some_tick() {
  const recording::FileSource source(kKept);
  const recording::Recording kept(source);
  v1::WorldState state;
  auto messages = kept.messages({.topics = {recording::kStateTopic}});
  if (messages.next()) messages.parse(state);
  return (state.tick() / kDecimation + 15) * kDecimation;
}

TEST(ReplayFile, WhatAnotherBuildRecordedIsTheSameToTheBit) {
  const Outcome outcome = run(kKept);
  EXPECT_TRUE(outcome.same) << outcome.text;
  EXPECT_NE(outcome.text.find("the same to the bit"), std::string::npos) << outcome.text;
  EXPECT_EQ(outcome.text.find("missing"), std::string::npos) << outcome.text;
}

TEST(ReplayFile, TheKeptRecordingGoesThroughWhatCanHappen) {
  std::set<int> kinds;
  copy_of("unused.mcap", test::TemporaryFolder(), of_inputs([&](v1::Frame& frame) {
            for (const auto& command : frame.inputs().command()) kinds.insert(command.kind());
            return true;
          }));
  EXPECT_EQ(kinds, (std::set<int>{v1::InputsFrame::PAUSE, v1::InputsFrame::RESUME, v1::InputsFrame::STEP,
                                  v1::InputsFrame::RESET, v1::InputsFrame::SCENE}));
}

TEST(ReplayFile, ASingleBitThatWasFlippedIsNamedAtItsTickWithTheHip) {
  const test::TemporaryFolder folder;
  const std::uint64_t tick = some_tick();
  const std::string file = copy_of("flipped.mcap", folder, of_inputs([tick](v1::Frame& frame) {
                                     if (frame.tick() != tick) return true;
                                     double& x = *frame.mutable_inputs()->mutable_position()->Mutable(1);
                                     x = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ 1U);
                                     return true;
                                   }));
  const Outcome outcome = run(file);
  EXPECT_FALSE(outcome.same);
  EXPECT_NE(outcome.text.find("tick " + std::to_string(tick) + " differs"), std::string::npos)
      << outcome.text;
  EXPECT_NE(outcome.text.find("HIP 0 of finger "), std::string::npos) << outcome.text;
  const Outcome json = run(file, true);
  EXPECT_NE(json.text.find("\"difference\":{\"tick\":" + std::to_string(tick)), std::string::npos)
      << json.text;
}

TEST(ReplayFile, InputsThatAreMissingAreTold) {
  const test::TemporaryFolder folder;
  const std::uint64_t tick = some_tick();
  const std::string file =
      copy_of("gap.mcap", folder, of_inputs([tick](const v1::Frame& frame) { return frame.tick() != tick; }));
  const Outcome outcome = run(file);
  EXPECT_TRUE(outcome.same);
  const std::string number = std::to_string(tick);
  EXPECT_NE(outcome.text.find("the inputs of ticks " + number + " to " + number + " are missing"),
            std::string::npos)
      << outcome.text;
  EXPECT_NE(outcome.text.find("cannot be replayed"), std::string::npos) << outcome.text;
}

TEST(ReplayFile, WithoutAStateThereIsNothingToReplay) {
  const test::TemporaryFolder folder;
  const std::string file =
      copy_of("stateless.mcap", folder,
              [](const std::string& topic, const std::string&) { return topic != recording::kStateTopic; });
  try {
    run(file);
    FAIL() << "it was replayed";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(file + ": has nothing to replay"), std::string::npos);
  }
}

TEST(ReplayFile, AFileThatIsNoRecordingIsToldByItsName) {
  try {
    run(test::source_dir() + "/README.md");
    FAIL() << "it was replayed";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("README.md"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace haptic::simulate
