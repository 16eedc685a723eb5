#pragma once
// Where recordings of faults lie:
//
//     DIRECTORY/fault-20261121T162319.123Z-over_speed.mcap      UTC, so that names sort by time
//     DIRECTORY/.fault-20261121T162319.123Z-over_speed.part     while it is written
//
// A thread of its own, which may take its time.

#include <cstdint>
#include <string>

#include "flight/excerpt.h"
#include "haptic/v1/config.pb.h"

namespace haptic::flight {

/// What the config names, else "faults" in the first folder of LOGS_DIRECTORY, which the service manager
/// sets. Empty: nothing is written.
std::string directory_of(const v1::FlightRecorder& config);

/// What is wrong with the directory, as far as that can be told before anything is written; empty: nothing.
/// It is made if only itself is missing.
std::string find_problem(const std::string& directory);

/// Writes a recording of a fault ("over_speed") that was latched then, and removes the oldest recordings but
/// `keep`. Returns its path. Throws recording::IoError; then no part of it is left.
std::string save(const Excerpt& excerpt, const std::string& directory, std::uint32_t keep,
                 const std::string& fault, std::uint64_t realtime_ns);

}  // namespace haptic::flight
