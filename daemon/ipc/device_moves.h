#pragma once
// Who moves which virtual device: one client at a time, its samples in their order. io thread.

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "ipc/publisher.h"
#include "ipc/servo_link.h"

namespace haptic::ipc {

/// A client that is silent for so long no longer moves a device: another may.
inline constexpr std::chrono::milliseconds kMoverSilence{100};

class DeviceMoves {
 public:
  struct Move {
    ClientId client = 0;
    std::string name;            // of the client, for others to read
    std::uint64_t sequence = 0;  // 0: not counted
    std::int64_t time_ns = 0;    // when it was measured
    SteadyClock::time_point arrived{};
  };

  /// Why the client may not move the device now: who else does. Nothing if it may.
  std::optional<std::string> refusal(std::uint32_t device, ClientId client,
                                     SteadyClock::time_point now) const;

  /// Whether something newer of the device has come: of another client by its time, of this one by its
  /// sequence, too.
  bool is_old(std::uint32_t device, ClientId client, std::uint64_t sequence, std::int64_t time_ns) const;

  /// Only what is neither refused nor old.
  void take(std::uint32_t device, Move move);

 private:
  std::map<std::uint32_t, Move> last_;  // by device
};

}  // namespace haptic::ipc
