#pragma once
// The faults since the daemon's start: what a person asks for who comes to a device that no longer pushes.
// The last hundred are kept, all are counted. io thread.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"

namespace haptic::ipc {

class FaultHistory {
 public:
  static constexpr int kKept = 100;

  /// One that has just been latched. Returns its number, from 1.
  std::uint64_t add(const v1::Fault& fault, std::uint64_t monotonic_ns, std::uint64_t realtime_ns);

  /// What was latched no longer is.
  void clear();

  /// What came before these faults is in a file.
  void set_recording(const std::vector<std::uint64_t>& faults, const std::string& path);

  /// The oldest first.
  const v1::FaultList& list() const noexcept { return list_; }

  const std::map<v1::FaultKind, std::uint64_t>& counts() const noexcept { return counts_; }

 private:
  v1::FaultList list_;
  std::uint64_t last_ = 0;  // number of the newest
  std::map<v1::FaultKind, std::uint64_t> counts_;
};

}  // namespace haptic::ipc
