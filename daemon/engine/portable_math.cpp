#include "engine/portable_math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace haptic::engine {
namespace {

// pi/2 in two parts; the first has 33 bits, so that its product with a quadrant number is exact
constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
constexpr double kHalfPiLow = 6.07710050650619224932e-11;
constexpr double kTwoOverPi = 0.63661977236758134308;

// below this, the terms of decay()'s series that are left away are below 1e-18
constexpr double kShortDecay = 0.5;
// exp(-a) is no longer a normal number
constexpr double kLongDecay = 708.0;

// 1 - x r0 (1 - x r1 (1 - ...: both series of the circular functions, by the ratios of their terms
template <std::size_t N>
double alternating_series(double x, const std::array<double, N>& ratios) noexcept {
  double sum = 1.0;
  for (std::size_t i = N; i-- > 0;) sum = 1.0 - x * ratios[i] * sum;
  return sum;
}

// 1 / (n (n + 1)) for n = first, first + 2 ...
template <std::size_t N>
constexpr std::array<double, N> ratios_from(int first) noexcept {
  std::array<double, N> ratios{};
  for (std::size_t i = 0; i < N; ++i, first += 2) ratios[i] = 1.0 / (first * (first + 1));
  return ratios;
}

// |r| <= pi/4: the first omitted terms are 1e-19 and 2e-18
SinCos sin_cos_of_octant(double r) noexcept {
  constexpr auto kSine = ratios_from<8>(2);
  constexpr auto kCosine = ratios_from<8>(1);
  const double square = r * r;
  return {r * alternating_series(square, kSine), alternating_series(square, kCosine)};
}

}  // namespace

SinCos sin_cos(double angle) noexcept {
  // written so that even NaN comes out bounded
  const double x = angle < kLongestAngle ? std::max(angle, -kLongestAngle) : kLongestAngle;
  const double quadrant = std::floor(x * kTwoOverPi + 0.5);
  const SinCos r = sin_cos_of_octant((x - quadrant * kHalfPiHigh) - quadrant * kHalfPiLow);
  switch (static_cast<long>(quadrant) & 3) {
    case 0:
      return r;
    case 1:
      return {r.cosine, -r.sine};
    case 2:
      return {-r.sine, -r.cosine};
    default:
      return {-r.cosine, r.sine};
  }
}

glm::dquat rotation_by(const glm::dvec3& rotation_vector) noexcept {
  const double angle =
      std::sqrt(rotation_vector.x * rotation_vector.x + rotation_vector.y * rotation_vector.y +
                rotation_vector.z * rotation_vector.z);
  // zero also where the squares vanish: such a turn moves no point
  if (angle == 0.0 || !std::isfinite(angle)) return {1.0, 0.0, 0.0, 0.0};
  const SinCos half = sin_cos(0.5 * angle);
  return {half.cosine, (half.sine / angle) * rotation_vector};
}

Decay decay(double a) noexcept {
  if (!(a < kLongDecay)) return {0.0, 1.0 / a};
  int doublings = 0;
  for (; a > kShortDecay; a *= 0.5) ++doublings;
  // (1 - exp(-a)) / a = 1 - a/2 (1 - a/3 (1 - ...
  double mean = 1.0;
  for (int n = 16; n >= 2; --n) mean = 1.0 - a / n * mean;
  double kept = 1.0 - a * mean;
  for (; doublings > 0; --doublings) {
    mean *= 0.5 * (1.0 + kept);
    kept *= kept;
  }
  return {kept, mean};
}

}  // namespace haptic::engine
