#pragma once
// Paths in time from CSV files: a header `time,x,y,z` or `time,x,y,z,qw,qx,qy,qz`, then one row per moment,
// in seconds and metres, times ascending. Orientations are normalised; without them a path does not turn.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/path.h"

namespace haptic::load {

/// Throws LoadError with line, column and the name of the CSV column. The result has at least one row.
std::vector<drivers::PathPoint> read_path(const std::filesystem::path& file);

/// The same from memory; `file` is only a name for errors.
std::vector<drivers::PathPoint> parse_path(std::string_view text, const std::string& file);

}  // namespace haptic::load
