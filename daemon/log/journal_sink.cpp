#include "log/journal_sink.h"

#include <sys/stat.h>
#include <syslog.h>
#include <systemd/sd-journal.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "log/fields.h"

namespace haptic::log {

namespace {

int priority_of(spdlog::level::level_enum level) noexcept {
  switch (level) {
    case spdlog::level::trace:
    case spdlog::level::debug:
      return LOG_DEBUG;
    case spdlog::level::info:
      return LOG_INFO;
    case spdlog::level::warn:
      return LOG_WARNING;
    case spdlog::level::critical:
      return LOG_CRIT;
    default:
      return LOG_ERR;
  }
}

}  // namespace

bool is_journal(int descriptor) {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat status {};
  if (stream == nullptr || ::fstat(descriptor, &status) != 0) return false;
  return stream == std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

JournalSink::JournalSink() : JournalSink(&::sd_journal_sendv) {}

void JournalSink::sink_it_(const spdlog::details::log_msg& line) {
  std::vector<std::string> texts = {"MESSAGE=" + std::string(line.payload.data(), line.payload.size()),
                                    "PRIORITY=" + std::to_string(priority_of(line.level)),
                                    "SYSLOG_IDENTIFIER=hapticd"};
  for (const auto& [name, value] : current_fields())
    texts.push_back(std::string(name).append("=").append(value));
  std::vector<iovec> fields;
  fields.reserve(texts.size());
  for (std::string& text : texts) fields.push_back({.iov_base = text.data(), .iov_len = text.size()});
  send_(fields.data(), static_cast<int>(fields.size()));
}

}  // namespace haptic::log
