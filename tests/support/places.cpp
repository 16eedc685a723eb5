#include "tests/support/places.h"

namespace haptic::test {

std::string source_dir() { return HAPTIC_SOURCE_DIR; }

std::string build_dir() { return HAPTIC_BUILD_DIR; }

}  // namespace haptic::test
