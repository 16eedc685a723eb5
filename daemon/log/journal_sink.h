#pragma once
// Lines for journald as it wants them: with their priority and with the fields of fields.h.

#include <spdlog/sinks/base_sink.h>
#include <sys/uio.h>

#include <mutex>
#include <string>

namespace haptic::log {

/// Whether what is written to the descriptor goes to the journal: JOURNAL_STREAM is "device:inode" of it.
bool is_journal(int descriptor);

class JournalSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// Sends one entry, as sd_journal_sendv() does.
  using Send = int (*)(const iovec* fields, int count);

  /// To the journal.
  JournalSink();
  explicit JournalSink(Send send) noexcept : send_(send) {}

 private:
  void sink_it_(const spdlog::details::log_msg& line) override;
  void flush_() override {}

  Send send_;
};

}  // namespace haptic::log
