// Paths from CSV: what is accepted ascends in time and samples to finite numbers.

#include <cmath>
#include <cstdlib>

#include "load/error.h"
#include "load/path_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  try {
    const auto path = load::parse_path({reinterpret_cast<const char*>(data), size}, "f");
    if (path.empty()) std::abort();
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i > 0 && !(path[i].time > path[i - 1].time)) std::abort();
      const drivers::PathSample sample = drivers::sample(path, path[i].time, true);
      if (!std::isfinite(sample.position.x + sample.velocity.x + sample.orientation.w)) std::abort();
    }
  } catch (const load::LoadError&) {
    return 0;
  }
  return 0;
}
