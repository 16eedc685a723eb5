#pragma once
// `hapticd simulate --replay`: a recording (proto/recording) through the tick again, and whether every tick
// ends in the state that it ended in then.

#include <iosfwd>
#include <string>

namespace haptic::simulate {

struct ReplayOptions {
  std::string file;   // MCAP, as `hapticctl record` writes it
  bool json = false;  // one JSON object instead of text
};

/// Tells on `out` what was found: how many ticks are the same to the bit, which cannot be replayed because
/// inputs are missing before them, and the first one that differs. Returns whether none does. Throws
/// std::runtime_error naming the file if it cannot be read, is wrong, or has nothing to replay.
bool replay(const ReplayOptions& options, std::ostream& out);

}  // namespace haptic::simulate
