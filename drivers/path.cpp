#include "drivers/path.h"

#include <algorithm>
#include <cmath>

namespace haptic::drivers {

PathSample sample(std::span<const PathPoint> path, double time, bool repeat) noexcept {
  if (path.empty()) return {};
  const PathPoint& first = path.front();
  const PathPoint& last = path.back();
  const double period = last.time - first.time;
  if (repeat && period > 0.0 && time >= last.time) time = first.time + std::fmod(time - first.time, period);

  // negated so that a time that is no number holds the first row
  if (!(time >= first.time)) return {first.position, first.orientation, glm::dvec3(0.0)};
  if (time >= last.time) return {last.position, last.orientation, glm::dvec3(0.0)};

  const auto after = std::upper_bound(path.begin(), path.end(), time,
                                      [](double t, const PathPoint& point) { return t < point.time; });
  const PathPoint& b = *after;
  const PathPoint& a = *(after - 1);
  const double duration = b.time - a.time;
  const double part = (time - a.time) / duration;
  return {a.position + part * (b.position - a.position),
          glm::normalize(glm::slerp(a.orientation, b.orientation, part)),
          (b.position - a.position) / duration};
}

}  // namespace haptic::drivers
