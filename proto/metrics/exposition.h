#pragma once
// What the daemon tells of itself as numbers that Prometheus reads: its text format 0.0.4. Base units, names
// that begin with hapticd_, counters that end in _total. The one place where they are named, for the daemon's
// endpoint and for `hapticctl stats --prometheus`.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "haptic/v1/control.pb.h"

namespace haptic::metrics {

inline constexpr const char* kContentType = "text/plain; version=0.0.4; charset=utf-8";

struct Numbers {
  v1::Status status;
  v1::DeviceList devices;
  v1::Stats stats;
  /// How often each fault has been latched since the daemon's start; nothing: not known for certain, and then
  /// not told.
  std::optional<std::map<v1::FaultKind, std::uint64_t>> faults;
};

/// The counts of a list that is complete: the daemon's history has `most` at the most, and drops older ones.
std::optional<std::map<v1::FaultKind, std::uint64_t>> count_faults(const v1::FaultList& faults, int most);

std::string exposition(const Numbers& numbers);

}  // namespace haptic::metrics
