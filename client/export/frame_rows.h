#pragma once
// Messages of a recording as rows of a table. Pure, but for what it is told of scenes and devices.

#include <map>
#include <string>
#include <vector>

#include "client/export/tables.h"
#include "haptic/v1/control.pb.h"

namespace haptic::exporting {

/// What the indices in frames mean. A name that is not known, since the recording does not tell it, is "#"
/// and the index.
struct Naming {
  std::map<std::uint64_t, v1::SceneDescription> scenes{};  // by revision
  std::vector<std::string> devices{};
  double rate_hz = 0.0;  // of ticks
};

/// Adds the rows of one frame to the table of `topic`, none if the frame does not tell of it. Throws
/// recording::FormatError if the lists of the frame do not fit together.
void add_rows(Topic topic, const v1::Frame& frame, const Naming& naming, TableWriter& table);

/// The row of a gap.
void add_row(const v1::Gap& gap, TableWriter& table);

}  // namespace haptic::exporting
