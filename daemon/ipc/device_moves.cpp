#include "ipc/device_moves.h"

#include <algorithm>
#include <utility>

namespace haptic::ipc {

std::optional<std::string> DeviceMoves::refusal(std::uint32_t device, ClientId client,
                                                SteadyClock::time_point now) const {
  const auto found = last_.find(device);
  if (found == last_.end() || found->second.client == client || now - found->second.arrived > kMoverSilence) {
    return std::nullopt;
  }
  return found->second.name + " moves this device";
}

bool DeviceMoves::is_old(std::uint32_t device, ClientId client, std::uint64_t sequence,
                         std::int64_t time_ns) const {
  const auto found = last_.find(device);
  if (found == last_.end()) {
    return false;
  }
  const Move& last = found->second;
  return time_ns < last.time_ns || (last.client == client && sequence != 0 && sequence <= last.sequence);
}

void DeviceMoves::take(std::uint32_t device, Move move) {
  Move& last = last_[device];
  if (last.client == move.client) {
    move.sequence = std::max(move.sequence, last.sequence);
  }
  last = std::move(move);
}

}  // namespace haptic::ipc
