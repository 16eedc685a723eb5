#pragma once
// The newest value from one thread to one other: the writer never waits for the reader, the reader always
// finds the newest value that was finished, and neither copies. Three slots; at each moment the writer fills
// one, the reader looks at one, and the third lies between them and is exchanged.
//
//     writer [a]  --publish-->  [b] newest  --update-->  [c] reader
//
// Both sides are wait-free. Exactly one thread may write and exactly one may read.

#include <array>
#include <atomic>
#include <cstdint>

namespace haptic::rt {

template <class T>
class TripleBuffer {
 public:
  /// Every slot starts as T{}; the reader sees that until the first publish().
  TripleBuffer() = default;

  /// Every slot starts as `initial`.
  explicit TripleBuffer(const T& initial) : slots_{initial, initial, initial} {}

  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /// Writer: the slot to fill. It holds some older value, so all of it must be written.
  T& writable() noexcept { return slots_[writing_]; }

  /// Writer: makes what writable() holds the newest value.
  void publish() noexcept {
    writing_ =
        between_.exchange(static_cast<std::uint8_t>(writing_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }

  /// Writer: copies `value` and publishes it.
  void write(const T& value) noexcept {
    writable() = value;
    publish();
  }

  /// Reader: takes the newest value, so that latest() shows it. False if there is none since the last call.
  bool update() noexcept {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  /// Reader: what the last update() took; stays unchanged until the next one.
  const T& latest() const noexcept { return slots_[reading_]; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;  // the slot between was published and not yet read
  static constexpr std::size_t kCacheLine = 64;

  std::array<T, 3> slots_{};
  alignas(kCacheLine) std::uint8_t writing_ = 0;  // writer's
  alignas(kCacheLine) std::atomic<std::uint8_t> between_{1};
  alignas(kCacheLine) std::uint8_t reading_ = 2;  // reader's
};

}  // namespace haptic::rt
