#pragma once
// The last ticks as bytes, in memory that is reserved once and gone around: the newest go over the oldest.
//
//     | newest ...   free   | held: oldest ...   newer ... |   ->   | newer ... newest   free |
//
// What is being written to a file is held: nothing goes over it, and when all the rest is full, what comes is
// not kept until it is released. io thread, but for the bytes of held entries, which another thread may read.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string_view>
#include <vector>

namespace haptic::flight {

enum class EntryKind : std::uint8_t {
  kTick,   // a v1::Frame of a tick, without its sequence and subscription
  kOther,  // the same of an event
  kState,  // a v1::WorldState
};

struct Entry {
  EntryKind kind = EntryKind::kTick;
  std::uint64_t tick = 0;
  std::uint64_t sequence = 0;  // of a frame
  std::uint32_t subscription = 0;
  std::string_view bytes{};  // within the tape
};

class Tape {
 public:
  /// Reserves so many bytes.
  explicit Tape(std::size_t capacity);

  std::size_t capacity() const noexcept { return capacity_; }

  /// How many of the bytes are used from now on; at most the capacity. Others are touched no more.
  void use(std::size_t bytes) noexcept;

  /// Keeps a copy of `bytes` as those of the entry. False, and then nothing has changed: it is larger than
  /// what is used, or what is held is in its way.
  bool append(Entry entry, std::string_view bytes);

  /// Drops the oldest while they are of ticks before this; not while anything is held.
  void forget_before(std::uint64_t tick) noexcept;

  /// The oldest first.
  const std::deque<Entry>& entries() const noexcept { return entries_; }

  /// All that is there now stays until release().
  std::vector<Entry> hold();
  void release() noexcept { is_held_ = false; }

 private:
  std::size_t begin_of(const Entry& entry) const noexcept;

  std::size_t capacity_;
  std::size_t used_;
  std::unique_ptr<char[]> memory_;
  std::deque<Entry> entries_;
  std::size_t end_ = 0;  // of the newest
  bool is_held_ = false;
};

}  // namespace haptic::flight
