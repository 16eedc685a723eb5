// hapticctl doctor and latency: what they print of a machine, and their exit codes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace haptic::cli {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

test::Finished run(const std::string& arguments) {
  return test::run_program(test::hapticctl() + " --socket /nowhere/hapticd.sock " + arguments);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

TEST(DoctorVerb, TellsAVerdictOfWhateverADaemonNeeds) {
  const test::Finished told = run("doctor");
  for (const char* const about : {"user ", "config ", "kernel ", "limits ", "clock ", "versions "}) {
    EXPECT_THAT(told.output, HasSubstr(about));
  }
}

TEST(DoctorVerb, FailsIfSomethingKeepsADaemonFromServing) {
  const test::TemporaryFolder folder;
  const std::string config = folder.write(
      "config.txtpb", "listen { unix { path: \"" + folder.file("none/hapticd.sock") + "\" } }\n");
  const test::Finished told = run("doctor --config " + config);
  EXPECT_EQ(told.code, 1) << told.output;
  EXPECT_THAT(told.output,
              AllOf(HasSubstr("BAD      socket"), HasSubstr("none, where the daemon is to listen"),
                    HasSubstr("$ sudo install -d")));
}

TEST(DoctorVerb, NamesTheLineOfAConfigThatItCannotRead) {
  const test::TemporaryFolder folder;
  const test::Finished told = run("doctor --config " + folder.write("wrong.txtpb", "device { arm: 1 }\n"));
  EXPECT_EQ(told.code, 1) << told.output;
  EXPECT_THAT(told.output, AllOf(HasSubstr("wrong.txtpb:1:"), HasSubstr("arm")));
}

TEST(DoctorVerb, PrintsOneObjectAVerdict) {
  const test::Finished told = run("doctor --json");
  EXPECT_GT(count_of(told.output, "\"verdict\":"), 5U) << told.output;
  EXPECT_EQ(count_of(told.output, "\"verdict\":"), count_of(told.output, "\n"));
}

TEST(LatencyVerb, TellsWhatItHasMeasured) {
  const test::Finished told = run("latency --seconds 0.1 --rate 500");
  EXPECT_EQ(told.code, 0) << told.output;
  EXPECT_THAT(told.output,
              AllOf(HasSubstr("500 Hz for 0.1 s"), ContainsRegex("[0-9]+ wake-ups, [0-9]+ missed periods"),
                    HasSubstr("p99.9")));
}

TEST(LatencyVerb, PrintsAHistogramForPrograms) {
  const test::Finished told = run("latency --seconds 0.1 --json");
  EXPECT_EQ(told.code, 0) << told.output;
  EXPECT_THAT(told.output,
              AllOf(HasSubstr("\"rate_hz\":1000"), HasSubstr("\"histogram\":["), HasSubstr("\"missed\":")));
}

}  // namespace
}  // namespace haptic::cli
