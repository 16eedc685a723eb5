#pragma once
// How long to wait before a device is looked for again. Pure: the time that passes is told.
//
//     it was looked for, and was not there or could not be opened:
//         0.1 s, 0.2 s, 0.4 s ... 5 s, and at once when something is plugged in
//     it was opened, and lost:
//         0.1 s, whatever is plugged in; and for each time in a row that it was not open for 10 s twice as
//         long, up to 60 s: a loose plug must not keep the motors jerking

#include <algorithm>
#include <chrono>

namespace haptic::drivers {

inline constexpr std::chrono::milliseconds kFirstWait{100};
inline constexpr std::chrono::milliseconds kLongestSearchWait{5'000};
inline constexpr std::chrono::milliseconds kLongestDropWait{60'000};
/// A device that was open for so long has not merely flickered.
inline constexpr std::chrono::milliseconds kLastingConnection{10'000};

class Reconnection {
 public:
  using Wait = std::chrono::milliseconds;

  /// It was looked for in vain: how long until the next time, unless something is plugged in before.
  Wait not_opened() noexcept {
    const Wait wait = search_wait_;
    search_wait_ = std::min(2 * search_wait_, kLongestSearchWait);
    return wait;
  }

  /// Something was plugged in.
  void plugged_in() noexcept { search_wait_ = kFirstWait; }

  /// It was lost after so long: how long it is left alone.
  Wait dropped(std::chrono::nanoseconds open_for) noexcept {
    if (open_for >= kLastingConnection) *this = {};
    search_wait_ = kFirstWait;
    ++drops_;
    const Wait wait = drop_wait_;
    drop_wait_ = std::min(2 * drop_wait_, kLongestDropWait);
    return wait;
  }

  /// In a row, each soon after it was opened.
  unsigned drops() const noexcept { return drops_; }

 private:
  Wait search_wait_ = kFirstWait;
  Wait drop_wait_ = kFirstWait;
  unsigned drops_ = 0;
};

}  // namespace haptic::drivers
