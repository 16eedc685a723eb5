// Scripts as hapticctl runs them: what they print, where they stop, and their exit codes.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/toy_daemon.h"

namespace haptic::cli {
namespace {

using test::Finished;

class ScriptRun : public testing::Test {
 protected:
  Finished run(const std::string& script, const std::string& options = "") {
    const std::string path = folder_.write("test.script", script);
    return test::run_program(test::hapticctl() + " --socket " + daemon_.address() + " run " + path + " " +
                             options);
  }
  // the output, with the script's own folder left away
  std::string output(const Finished& finished) const {
    std::string text = finished.output;
    const std::string folder = folder_.file("");
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder)) {
      text.erase(at, folder.size());
    }
    return text;
  }

  test::TemporaryFolder folder_;
  test::ToyDaemon daemon_;
};

TEST_F(ScriptRun, DoesOneLineAfterTheOtherOverOneConnection) {
  const Finished done =
      run("set n 2\narm\nfor i in 1 $n\n  echo turn $i\nend\nobject move box --at 0 0.2 0\ndisarm\n");
  EXPECT_EQ(done.code, 0) << done.output;
  EXPECT_EQ(output(done),
            "armed: devices may push now\nturn 1\nturn 2\nmoved object box (revision 2)\ndisarmed: no device "
            "pushes\n");
  EXPECT_EQ(daemon_.connections(), 1);
}

TEST_F(ScriptRun, StopsAtTheFirstLineThatFailsWithItsExitCode) {
  const Finished refused = run("echo before\nobject remove nobody\necho after\n");
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(output(refused), "before\ntest.script:2: remove_object: there is no object \"nobody\"\n");
}

TEST_F(ScriptRun, ChecksAllOfItBeforeAnythingRuns) {
  for (const char* mistake :
       {"object mvoe box --at 0 0 0", "wait 2", "wait until tick > 1", "expect tick", "run other",
        "arm --socket /elsewhere", "arm --help", "end", "object add box --sphere", "echo 'x", "start",
        "start arm", "start record", "stop", "stop arm"}) {
    const Finished wrong = run("arm\n" + std::string(mistake) + "\n");
    EXPECT_EQ(wrong.code, 64) << mistake;
    EXPECT_EQ(output(wrong).rfind("test.script:2: ", 0), 0U) << wrong.output;
  }
  EXPECT_EQ(daemon_.connections(), 0);
}

TEST_F(ScriptRun, GoesOnWhereThereIsNothingToDo) {
  const Finished done = run("arm\narm\necho on\n");
  EXPECT_EQ(done.code, 0);
  EXPECT_EQ(output(done), "armed: devices may push now\ntest.script:2: it is armed already\non\n");
}

TEST_F(ScriptRun, HoldsTheLeaseFromTheFirstLineThatArmsUntilItsEnd) {
  EXPECT_EQ(run("echo only\nexpect object box.y > 0\n").code, 0);
  EXPECT_EQ(daemon_.leases(), 0);
  const Finished done = run("arm\nwait 500ms\narm\n");
  EXPECT_EQ(done.code, 0) << done.output;
  EXPECT_EQ(daemon_.leases(), 1);
  EXPECT_EQ(daemon_.releases(), 1);
  EXPECT_GE(daemon_.heartbeats(), 5);  // of 20 that are due in half a second with 25 ms between them
}

TEST_F(ScriptRun, SendsHeartbeatsWhileAVerbWorksOnAFile) {
  // nobody can open the pipe for reading before it is opened for writing
  const std::string pipe = folder_.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::jthread writing([&pipe](const std::stop_token& stop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const int writer = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC);
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ::close(writer);
  });
  EXPECT_EQ(run("arm\ninfo " + pipe + "\n").code, 1);  // a pipe is no recording
  EXPECT_GE(daemon_.heartbeats(), 5);  // of 20 that are due in half a second with 25 ms between them
}

TEST_F(ScriptRun, GivesTheLeaseBackWhenALineFails) {
  EXPECT_EQ(run("arm\nexpect object box.y > 1\n").code, 1);
  EXPECT_EQ(daemon_.releases(), 1);
}

TEST_F(ScriptRun, ArmsOnlyIfItMayHaveTheLeaseButMovesWithoutIt) {
  daemon_.refuse_lease(v1::Error::REFUSED);
  const Finished refused = run("echo a\narm\n");
  EXPECT_EQ(refused.code, 4);
  EXPECT_EQ(output(refused), "a\ntest.script:2: no lease for you\n");
  EXPECT_EQ(run("object move box --at 0 0.2 0\n").code, 0);
}

TEST_F(ScriptRun, ArmsWithoutALeaseWhereTheDaemonHasNone) {
  daemon_.refuse_lease(v1::Error::UNSUPPORTED);
  EXPECT_EQ(run("arm\n").code, 0);
}

TEST_F(ScriptRun, TakesTheLeaseToMoveIfItIsFree) {
  EXPECT_EQ(run("object move box --at 0 0.2 0\n").code, 0);
  EXPECT_EQ(daemon_.leases(), 1);
  EXPECT_EQ(daemon_.releases(), 1);
}

TEST_F(ScriptRun, TakesTheLeaseToMoveADevice) {
  EXPECT_EQ(run("device move mouse --at 0 0.2 0\n").code, 3) << "the toy has none";
  EXPECT_EQ(daemon_.leases(), 1);
  EXPECT_EQ(daemon_.releases(), 1);
}

TEST_F(ScriptRun, FailsWhenAnExpectationDoes) {
  EXPECT_EQ(run("expect object box.y == 0.05 within 1e-6\n").code, 0);
  const Finished failed = run("\nexpect object box.y > 0.1\n");
  EXPECT_EQ(failed.code, 1);
  EXPECT_EQ(output(failed), "test.script:2: expected object box.y > 0.1; it is 0.05\n");
  EXPECT_EQ(run("expect object nobody.y > 0.1\n").code, 3);
}

TEST_F(ScriptRun, WaitsUntilSomethingIsSoOrTheTimeIsOver) {
  EXPECT_EQ(run("wait until tick > 20 for 5s\nwait 1ms\n").code, 0);
  const Finished late = run("wait until object box.y > 0.1 for 50ms\n");
  EXPECT_EQ(late.code, 1);
  EXPECT_EQ(output(late), "test.script:1: object box.y > 0.1 did not come true within 0.05 s; it is 0.05\n");
}

TEST_F(ScriptRun, TakesVariablesFromTheCommandLine) {
  EXPECT_EQ(output(run("set a 1\necho $a $b\n", "--define a=7 --define b='x y'")), "7 x y\n");
  EXPECT_EQ(run("", "--define 1=2").code, 64);
}

TEST_F(ScriptRun, ReadsStandardInput) {
  const Finished done = test::run_program("printf 'echo hello\\nend\\n' | " + test::hapticctl() + " run -");
  EXPECT_EQ(done.code, 64);
  EXPECT_EQ(done.output, "standard input:2: end without for\n");
  EXPECT_EQ(test::run_program(test::hapticctl() + " run /nowhere.script").code, 3);
}

TEST_F(ScriptRun, ExitsWithFiveWhenTheDaemonIsUnreachable) {
  const std::string path = folder_.write("test.script", "arm\n");
  EXPECT_EQ(test::run_program(test::hapticctl() + " --socket /nowhere/s run " + path).code, 5);
}

TEST_F(ScriptRun, EndsWhenItIsInterrupted) {
  const std::string path = folder_.write("test.script", "echo begun\nwait 1min\necho never\n");
  const Finished stopped =
      test::run_program("timeout --signal=INT --preserve-status 0.5 " + test::hapticctl() + " run " + path);
  EXPECT_EQ(stopped.code, 1);
  EXPECT_EQ(output(stopped), "begun\ntest.script:2: stopped by a signal\n");
}

TEST_F(ScriptRun, ShowsTheFieldOfARefusal) {
  const Finished refused =
      test::run_program(test::hapticctl() + " --socket " + daemon_.address() + " gravity set 0 -2000 0");
  EXPECT_EQ(refused.code, 1);
  EXPECT_EQ(refused.output, "hapticctl: edit[0].set_gravity.y: -2000 is out of range\n");
}

TEST_F(ScriptRun, SavesTheSceneOnceAndReplacesItOnlyByForce) {
  const std::string path = folder_.file("saved.scene.txtpb");
  const std::string save = test::hapticctl() + " --socket " + daemon_.address() + " scene save " + path;
  EXPECT_EQ(test::run_program(save).code, 0);
  const Finished again = test::run_program(save);
  EXPECT_EQ(again.code, 1);
  EXPECT_EQ(output(again), "hapticctl: cannot write saved.scene.txtpb: it exists; --force replaces it\n");
  EXPECT_EQ(test::run_program(save + " --force").code, 0);
  EXPECT_EQ(test::run_program("grep -c 'name: \"box\"' " + path).output, "1\n");
  EXPECT_EQ(test::run_program("ls " + folder_.file("")).output, "saved.scene.txtpb\n");  // no draft is left
}

}  // namespace
}  // namespace haptic::cli
