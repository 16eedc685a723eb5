#pragma once
// A recording as tables for other programs.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "client/export/frame_rows.h"
#include "client/export/tables.h"
#include "proto/recording/recording.h"

namespace haptic::exporting {

enum class Format { kCsv, kHdf5 };

struct Plan {
  std::vector<Topic> topics{};  // none: all that the recording has; for CSV exactly one
  // of the log_time, in ns since the recording's start
  std::uint64_t from_ns = 0;
  std::uint64_t to_ns = std::numeric_limits<std::uint64_t>::max();  // exclusive
  std::string file{};
  Format format = Format::kCsv;
};

/// The recording does not have what is asked for.
class Missing : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The topics of which the recording has a channel.
std::vector<Topic> topics_in(const recording::Recording& recording);

/// Where messages of a topic are in a recording.
std::string channel_of(Topic topic);

/// What the indices in the recording's frames mean. Throws recording::FormatError, e.g. if the recording does
/// not tell the rate of its ticks, and recording::IoError.
Naming naming_of(const recording::Recording& recording);

/// Writes plan.file, of which nothing is seen before it is whole. Returns the rows of each topic. Throws
/// Missing, recording::FormatError, recording::IoError and csv::OutputError; then the file is as it was.
std::vector<std::pair<Topic, std::uint64_t>> export_tables(const recording::Recording& recording,
                                                           const Plan& plan);

}  // namespace haptic::exporting
