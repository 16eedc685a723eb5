#pragma once
// Passes lines on, but a few only of those that are alike, and not many at all in a short time:
//
//     tick 100: 3 ticks were missed
//     tick 107: 1 tick was missed          lines are alike if they differ in numbers only
//     40 more like this within 10 s: tick 912: 1 tick was missed
//
// Nothing disappears untold: what is held back is counted, and the count is told when the time is over, as
// soon as something else is logged or flush() is called.

#include <spdlog/sinks/base_sink.h>

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace haptic::log {

struct LineLimits {
  std::size_t alike = 5;  // lines within the time
  std::size_t all = 200;  // likewise, whatever they are
  std::chrono::seconds time{10};
};

class LimitedSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  LimitedSink(std::vector<spdlog::sink_ptr> sinks, const LineLimits& limits);
  /// Tells what is held back.
  ~LimitedSink() override;
  LimitedSink(const LimitedSink&) = delete;
  LimitedSink& operator=(const LimitedSink&) = delete;

 private:
  using Time = spdlog::log_clock::time_point;

  struct Kind {
    Time begin;
    std::size_t passed = 0;
    std::size_t held_back = 0;
    std::string last;  // of those held back
  };

  void sink_it_(const spdlog::details::log_msg& line) override;
  void flush_() override;

  bool is_over(Time begin, Time now) const noexcept;
  void tell_held_back(Time now, bool everything);
  void pass(const spdlog::details::log_msg& line);

  std::vector<spdlog::sink_ptr> sinks_;
  LineLimits limits_;
  std::map<std::pair<spdlog::level::level_enum, std::string>, Kind> kinds_;
  Time begin_{};            // of the time in which all lines are counted
  std::size_t passed_ = 0;  // in it
  std::size_t left_out_ = 0;
};

}  // namespace haptic::log
