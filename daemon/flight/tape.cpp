#include "flight/tape.h"

#include <algorithm>

namespace haptic::flight {

Tape::Tape(std::size_t capacity)
    : capacity_(capacity), used_(capacity), memory_(std::make_unique_for_overwrite<char[]>(capacity)) {}

void Tape::use(std::size_t bytes) noexcept { used_ = std::min(bytes, capacity_); }

std::size_t Tape::begin_of(const Entry& entry) const noexcept {
  return static_cast<std::size_t>(entry.bytes.data() - memory_.get());
}

bool Tape::append(Entry entry, std::string_view bytes) {
  if (bytes.size() > used_) return false;
  const bool wraps = end_ + bytes.size() > used_;
  const std::size_t begin = wraps ? 0 : end_;
  const std::size_t end = begin + bytes.size();
  // those that lie after the newest are older than those at the beginning
  const auto is_in_the_way = [&](const Entry& old) {
    const std::size_t at = begin_of(old);
    const std::size_t size = std::max<std::size_t>(1, old.bytes.size());
    return (wraps && at >= end_) || (at < end && at + size > begin);
  };
  if (is_held_ && std::any_of(entries_.begin(), entries_.end(), is_in_the_way)) return false;
  while (!entries_.empty() && is_in_the_way(entries_.front())) entries_.pop_front();
  std::copy(bytes.begin(), bytes.end(), memory_.get() + begin);
  entry.bytes = {memory_.get() + begin, bytes.size()};
  entries_.push_back(entry);
  end_ = end;
  return true;
}

void Tape::forget_before(std::uint64_t tick) noexcept {
  if (is_held_) return;
  while (!entries_.empty() && entries_.front().tick < tick) entries_.pop_front();
  if (entries_.empty()) end_ = 0;
}

std::vector<Entry> Tape::hold() {
  is_held_ = true;
  return {entries_.begin(), entries_.end()};
}

}  // namespace haptic::flight
