#include "log/limited_sink.h"

#include <algorithm>
#include <utility>

namespace haptic::log {

namespace {

constexpr std::size_t kMostKinds = 256;

/// What lines have in common that are alike.
std::string kind_of(const spdlog::string_view_t& text) {
  std::string kind;
  kind.reserve(text.size());
  std::copy_if(text.begin(), text.end(), std::back_inserter(kind), [](char c) { return c < '0' || c > '9'; });
  return kind;
}

}  // namespace

LimitedSink::LimitedSink(std::vector<spdlog::sink_ptr> sinks, const LineLimits& limits)
    : sinks_(std::move(sinks)), limits_(limits) {}

LimitedSink::~LimitedSink() {
  try {
    tell_held_back(spdlog::log_clock::now(), true);
    for (const spdlog::sink_ptr& inner : sinks_) inner->flush();
  } catch (const std::exception&) {
    // nobody is left to be told
  }
}

// the clock may have been set back
bool LimitedSink::is_over(Time begin, Time now) const noexcept {
  return now < begin || now - begin >= limits_.time;
}

void LimitedSink::pass(const spdlog::details::log_msg& line) {
  for (const spdlog::sink_ptr& inner : sinks_) {
    if (inner->should_log(line.level)) inner->log(line);
  }
}

void LimitedSink::tell_held_back(Time now, bool everything) {
  for (auto entry = kinds_.begin(); entry != kinds_.end();) {
    const Kind& kind = entry->second;
    if (!everything && !is_over(kind.begin, now)) {
      ++entry;
      continue;
    }
    if (kind.held_back > 0) {
      const std::string text = std::to_string(kind.held_back) + " more like this within " +
                               std::to_string(limits_.time.count()) + " s: " + kind.last;
      pass({now, {}, "hapticd", entry->first.first, text});
    }
    entry = kinds_.erase(entry);
  }
  if (!everything && !is_over(begin_, now)) return;
  if (left_out_ > 0) {
    const std::string text = std::to_string(left_out_) + " more lines within " +
                             std::to_string(limits_.time.count()) + " s were left out";
    pass({now, {}, "hapticd", spdlog::level::warn, text});
  }
  begin_ = now;
  passed_ = left_out_ = 0;
}

void LimitedSink::sink_it_(const spdlog::details::log_msg& line) {
  tell_held_back(line.time, false);
  auto entry = kinds_.find({line.level, kind_of(line.payload)});
  if (entry == kinds_.end() && kinds_.size() < kMostKinds) {
    entry = kinds_.emplace(std::pair(line.level, kind_of(line.payload)), Kind{.begin = line.time, .last = {}})
                .first;
  }
  if (entry != kinds_.end() && entry->second.passed >= limits_.alike) {
    ++entry->second.held_back;
    entry->second.last.assign(line.payload.data(), line.payload.size());
    return;
  }
  if (passed_ >= limits_.all) {
    ++left_out_;
    return;
  }
  if (entry != kinds_.end()) ++entry->second.passed;
  ++passed_;
  pass(line);
}

void LimitedSink::flush_() {
  tell_held_back(spdlog::log_clock::now(), false);
  for (const spdlog::sink_ptr& inner : sinks_) inner->flush();
}

}  // namespace haptic::log
