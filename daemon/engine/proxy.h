#pragma once
// The proxy (the paper's IHIP, ideal haptic interface point): what one HIP remembers about one object.

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

namespace haptic::engine {

/// Index of a cell, face, edge or vertex in its CellComplex.
using Index = std::uint32_t;
inline constexpr Index kNone = std::numeric_limits<Index>::max();

/// What holds the proxy (paper section 2.2, Table 1).
enum class ConstraintState : std::uint8_t {
  kTet,  // inside a cell
  kSur,  // on a face
  kEdg,  // on an edge
  kVer,  // on a vertex
  kOut,  // outside the complex; the proxy is the HIP
};
inline constexpr int kConstraintStates = 5;

/// "Tet", "Sur", "Edg", "Ver" or "Out".
constexpr const char* name_of(ConstraintState state) noexcept {
  constexpr const char* kNames[kConstraintStates] = {"Tet", "Sur", "Edg", "Ver", "Out"};
  return kNames[static_cast<int>(state)];
}

/// Rides in the object's frame, so that a moving object carries it: a still finger is met by it.
struct Proxy {
  glm::dvec3 position{0.0, 0.0, 0.0};  // m, object frame; in kOut the HIP of the last tick
  Index cell = kNone;                  // the belonging cell; kNone in kOut
  Index feature = kNone;               // the face, edge or vertex of kSur, kEdg, kVer; kNone otherwise
  ConstraintState state = ConstraintState::kOut;
  bool slipping = false;   // moved in the last tick: the paper's fric flag
  bool swallowed = false;  // started inside rigid material: no force until the HIP has left it
};

}  // namespace haptic::engine
