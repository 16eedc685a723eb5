#pragma once
// `hapticd check`: what a config and a scene say, as the daemon understands them, without running anything.

#include <iosfwd>
#include <string>

namespace haptic::load {

struct CheckOptions {
  std::string config;  // path; empty: only the scene is checked, against the default capacity
  std::string scene;   // path; empty: the one that the config names, if any
  bool json = false;   // one JSON object instead of text
};

/// Prints the report to `out`, and the first error to `err` (with `json` to `out` too, as {"error": ...}).
/// Returns the exit code: 0 if both files are good, 1 if one is not, 64 if neither was named.
int check(const CheckOptions& options, std::ostream& out, std::ostream& err);

}  // namespace haptic::load
