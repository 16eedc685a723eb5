#pragma once
// The releases with which this version must work.

#include <sstream>
#include <string>
#include <vector>

namespace haptic::test {

/// "v0_1", ...: the folders beside this file.
inline std::vector<std::string> frozen_releases() {
  std::istringstream names(HAPTIC_RELEASES);
  std::vector<std::string> releases;
  for (std::string name; names >> name;) {
    releases.push_back(name);
  }
  return releases;
}

}  // namespace haptic::test
