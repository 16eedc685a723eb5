#pragma once
// `hapticd check`: what a config and a scene say, as the daemon understands them, without running anything.

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "haptic/v1/config.pb.h"

namespace haptic::load {

/// What is wrong with a file that `listen.tcp.tls` names.
struct TlsProblem {
  std::string field;    // "certificate", "key" or "authority"
  std::string message;  // with the file's name
};

struct CheckOptions {
  std::string config;  // path; empty: only the scene is checked, against the default capacity
  std::string scene;   // path; empty: the one that the config names, if any
  bool json = false;   // one JSON object instead of text

  /// Opens the files of TLS. Empty: they are not looked at.
  std::function<std::vector<TlsProblem>(const v1::Listen::Tls&)> tls_problems{};
};

/// Prints the report to `out`, and the first error to `err` (with `json` to `out` too, as {"error": ...}). Of
/// the files of TLS each error is told (with `json` as {"error": the first, "errors": [...]}).
/// Returns the exit code: 0 if both files are good, 1 if one is not, 64 if neither was named.
int check(const CheckOptions& options, std::ostream& out, std::ostream& err);

}  // namespace haptic::load
