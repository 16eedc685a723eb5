#pragma once
// Where the tree and the programs under test are. A source of its own knows it, so that no test is compiled
// anew because the tree lies elsewhere.

#include <string>

namespace haptic::test {

/// Absolute, without a slash at the end.
std::string source_dir();
std::string build_dir();

inline std::string hapticctl() { return build_dir() + "/client/cli/hapticctl"; }
inline std::string haptic_bridge() { return build_dir() + "/client/bridge/haptic-bridge"; }

}  // namespace haptic::test
