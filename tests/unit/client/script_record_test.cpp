// What a script records beside its other lines.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "proto/recording/recording.h"
#include "proto/recording/source.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_daemon.h"

namespace haptic::cli {
namespace {

using test::Finished;

class ScriptRecord : public testing::Test {
 protected:
  Finished run(const std::string& script) {
    const std::string path = folder_.write("test.script", script);
    return test::run_program(test::hapticctl() + " --socket " + daemon_.address() + " run " + path);
  }
  // of a recording that is whole
  std::uint64_t frames(const std::string& file) const {
    const recording::FileSource source(folder_.file(file));
    const recording::Recording recording(source);
    EXPECT_EQ(recording.damage(), "");
    std::uint64_t count = 0;
    for (recording::Messages messages = recording.messages({.topics = {"/haptic/objects"}});
         messages.next();) {
      ++count;
    }
    return count;
  }
  std::string start(const std::string& file) const { return "start record " + folder_.file(file) + "\n"; }

  test::TemporaryFolder folder_;
  test::TestDaemon daemon_;
  std::jthread ticking_{[this](const std::stop_token& stop) {
    for (std::uint64_t tick = 2; !stop.stop_requested(); ++tick) {
      daemon_.servo().publish(tick);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }};
};

TEST_F(ScriptRecord, GoesOnBesideTheLinesThatFollowUntilItIsStopped) {
  const Finished done = run(start("a.mcap") + "wait 200ms\necho beside\nstop record\necho after\n");
  EXPECT_EQ(done.code, 0) << done.output;
  EXPECT_LT(done.output.find("beside\n"), done.output.find("a.mcap: ")) << done.output;
  EXPECT_LT(done.output.find("a.mcap: "), done.output.find("after\n")) << done.output;
  EXPECT_GT(frames("a.mcap"), 0U);
}

TEST_F(ScriptRecord, EndsWithTheScript) {
  const Finished done = run(start("a.mcap") + "wait 200ms\n");
  EXPECT_EQ(done.code, 0) << done.output;
  EXPECT_GT(frames("a.mcap"), 0U);
}

TEST_F(ScriptRecord, IsClosedWellWhenALineFails) {
  const Finished failed = run(start("a.mcap") + "wait 200ms\nexpect tick < 0\n");
  EXPECT_EQ(failed.code, 1) << failed.output;
  EXPECT_GT(frames("a.mcap"), 0U);
}

TEST_F(ScriptRecord, CanBeStartedAgain) {
  const Finished done = run(start("a.mcap") + "stop record\n" + start("b.mcap") + "stop record\n");
  EXPECT_EQ(done.code, 0) << done.output;
  EXPECT_TRUE(std::filesystem::exists(folder_.file("b.mcap")));
}

TEST_F(ScriptRecord, FailsAtItsLineWhenItCannotBegin) {
  folder_.write("there.mcap", "of somebody");
  const Finished failed = run("echo before\n" + start("there.mcap") + "echo after\n");
  EXPECT_EQ(failed.code, 1);
  EXPECT_NE(failed.output.find("test.script:2: "), std::string::npos) << failed.output;
  EXPECT_EQ(failed.output.find("after"), std::string::npos) << failed.output;
}

TEST_F(ScriptRecord, IsOneAtATime) {
  const Finished twice = run(start("a.mcap") + start("b.mcap"));
  EXPECT_EQ(twice.code, 1);
  EXPECT_NE(twice.output.find("test.script:2: something is recorded already"), std::string::npos)
      << twice.output;
  const Finished none = run("stop record\n");
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.output.find("test.script:1: nothing is recorded"), std::string::npos) << none.output;
}

}  // namespace
}  // namespace haptic::cli
