#include "log/limited_sink.h"

#include <gtest/gtest.h>

#include <memory>

namespace haptic::log {
namespace {

using std::chrono::seconds;

/// What has come through.
class Lines final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  std::vector<std::string> all;

 private:
  void sink_it_(const spdlog::details::log_msg& line) override {
    all.emplace_back(line.payload.data(), line.payload.size());
  }
  void flush_() override {}
};

struct Log {
  std::shared_ptr<Lines> lines = std::make_shared<Lines>();
  LimitedSink sink{{lines}, {.alike = 2, .all = 10, .time = seconds(10)}};
  // long ago, so that a flush, which asks the clock, finds every time over
  spdlog::log_clock::time_point start{seconds(1000)};

  void write(const std::string& text, seconds after = seconds(0),
             spdlog::level::level_enum level = spdlog::level::info) {
    sink.log({start + after, {}, "hapticd", level, text});
  }
};

using Expected = std::vector<std::string>;

TEST(LimitedSink, PassesLinesThatDiffer) {
  Log log;
  for (const char* text : {"a", "b", "c"}) log.write(text);
  EXPECT_EQ(log.lines->all, (Expected{"a", "b", "c"}));
}

TEST(LimitedSink, HoldsBackWhatIsAlikeAndTellsHowOftenItCame) {
  Log log;
  for (int i = 1; i <= 5; ++i) log.write("tick " + std::to_string(i) + " was missed");
  log.write("tick 9 was missed", seconds(0), spdlog::level::warn);  // of another level: not alike
  log.write("something else", seconds(11));
  EXPECT_EQ(log.lines->all, (Expected{"tick 1 was missed", "tick 2 was missed", "tick 9 was missed",
                                      "3 more like this within 10 s: tick 5 was missed", "something else"}));
}

TEST(LimitedSink, BeginsAnewAfterTheTime) {
  Log log;
  for (int i = 0; i < 3; ++i) log.write("again", seconds(20 * i));
  EXPECT_EQ(log.lines->all, (Expected{"again", "again", "again"}));
}

TEST(LimitedSink, BoundsABurstOfLinesThatAreNotAlike) {
  Log log;
  for (char c = 'a'; c < 'a' + 15; ++c) log.write(std::string(1, c));
  EXPECT_EQ(log.lines->all.size(), 10U);
  log.write("later", seconds(10));
  EXPECT_EQ(log.lines->all.at(10), "5 more lines within 10 s were left out");
  EXPECT_EQ(log.lines->all.at(11), "later");
}

TEST(LimitedSink, TellsWhatIsHeldBackWhenItIsFlushedAndAtTheEnd) {
  const auto lines = std::make_shared<Lines>();
  {
    LimitedSink sink({lines}, {.alike = 1, .all = 10, .time = seconds(3600)});
    sink.log({spdlog::log_clock::now(), {}, "hapticd", spdlog::level::info, "x"});
    sink.log({spdlog::log_clock::now(), {}, "hapticd", spdlog::level::info, "x"});
    sink.flush();
    EXPECT_EQ(lines->all.size(), 1U) << "the time is not over";
  }
  EXPECT_EQ(lines->all, (Expected{"x", "1 more like this within 3600 s: x"}));
  Log log;
  for (int i = 0; i < 3; ++i) log.write("y");
  log.sink.flush();
  EXPECT_EQ(log.lines->all.back(), "1 more like this within 10 s: y");
}

TEST(LimitedSink, GoesOnWhenTheClockWasSetBack) {
  Log log;
  for (int i = 0; i < 3; ++i) log.write("x");
  log.write("x", seconds(-500));
  EXPECT_EQ(log.lines->all, (Expected{"x", "x", "1 more like this within 10 s: x", "x"}));
}

}  // namespace
}  // namespace haptic::log
