#pragma once
// Puts meshes together from convex pieces. Pieces that share a face cut it in the same way, whatever their
// order: a quadrilateral is always cut through its vertex of lowest number.

#include <array>
#include <span>
#include <stdexcept>

#include "engine/cell_complex.h"
#include "engine/message.h"

namespace haptic::engine {

/// A face with three or four corners in order around it; a triangle has kNone for the fourth.
using PieceFace = std::array<Index, 4>;

/// Adds one cell, made positive whatever the order of its vertices.
void add_cell(TetraMesh& mesh, std::array<Index, 4> vertices, std::int32_t tag);

/// Adds a convex piece with plane faces: three cells for a prism, five or six for a hexahedron.
void add_piece(TetraMesh& mesh, std::span<const PieceFace> faces, std::int32_t tag);

/// Adds the prism between two triangles whose corners correspond.
void add_prism(TetraMesh& mesh, const std::array<Index, 3>& bottom, const std::array<Index, 3>& top,
               std::int32_t tag);

/// Throws std::invalid_argument with the message of the parts unless `holds`.
template <class... Parts>
void require(bool holds, const Parts&... parts) {
  if (!holds) throw std::invalid_argument(message(parts...));
}

/// No length of a shape may be below this fraction of its largest: thinner cells would be flat (kFlatCell),
/// with room for what a cell is thinner than the lengths that it is made from.
inline constexpr double kSmallestRatio = 1e-6;

/// A length of a shape, for messages.
struct Length {
  const char* name;
  double value;  // m
};

/// Throws unless all are finite and positive, and none is below kSmallestRatio of the largest.
void require_lengths(std::span<const Length> lengths);

/// Throws unless `air_margin` is 0 or a length that goes with `size`, the largest of the shape.
void require_margin(double air_margin, double size);

}  // namespace haptic::engine
