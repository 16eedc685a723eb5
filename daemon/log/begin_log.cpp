#include "log/begin_log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "log/journal_sink.h"
#include "log/limited_sink.h"

namespace haptic::log {

namespace {

constexpr std::size_t kFilesKept = 3;

/// The level as journald reads it at the beginning of a line: "<4>" for a warning.
class JournalLevel final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/,
              spdlog::memory_buf_t& line) override {
    const char* level = "<6>";
    if (message.level == spdlog::level::debug || message.level == spdlog::level::trace) level = "<7>";
    if (message.level == spdlog::level::warn) level = "<4>";
    if (message.level >= spdlog::level::err) level = "<3>";
    line.append(level, level + 3);
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return std::make_unique<JournalLevel>();
  }
};

spdlog::sink_ptr standard_error(bool foreground) {
  if (is_journal(STDERR_FILENO)) return std::make_shared<JournalSink>();
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  if (foreground) {
    sink->set_pattern("%H:%M:%S.%e %^%l%$ %v");
    return sink;
  }
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<JournalLevel>('*').set_pattern("%*%v");
  sink->set_formatter(std::move(formatter));
  return sink;
}

spdlog::sink_ptr open_file(const v1::Log& config) {
  try {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(
        config.file(), static_cast<std::size_t>(config.file_bytes()), kFilesKept);
    sink->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %v");
    return sink;
  } catch (const spdlog::spdlog_ex& error) {
    throw std::runtime_error(std::string("log.file: ") + error.what());
  }
}

spdlog::level::level_enum level_of(v1::Log::Level level) noexcept {
  switch (level) {
    case v1::Log::DEBUG:
      return spdlog::level::debug;
    case v1::Log::WARNING:
      return spdlog::level::warn;
    case v1::Log::ERROR:
      return spdlog::level::err;
    default:
      return spdlog::level::info;
  }
}

}  // namespace

void begin_log(const v1::Log& config, bool foreground) {
  std::vector<spdlog::sink_ptr> sinks = {standard_error(foreground)};
  if (!config.file().empty()) sinks.push_back(open_file(config));
  const auto logger = std::make_shared<spdlog::logger>(
      "hapticd", std::make_shared<LimitedSink>(std::move(sinks), LineLimits()));
  logger->set_level(level_of(config.level()));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

}  // namespace haptic::log
