#pragma once
// What a mesh must be before anything is computed from it. All functions throw MeshError; none is real-time
// safe. Vertices and cells are counted from 0 in the messages.

#include "engine/cell_complex.h"

namespace haptic::engine {

/// Cells of one mesh. The longest table (faces of vertices: at most 3 for each of 4 faces of a cell) is
/// indexed by 32 bits.
inline constexpr std::size_t kMaxCells = kNone / 12;

/// "cell 7 (vertices 1, 2, 3, 9)"
std::string describe_cell(const TetraMesh& mesh, Index cell);

/// Refuses an empty mesh, tables of different or impossible sizes, indices out of range, repeated vertices
/// and non-finite coordinates. Returns the bounding box of the vertices that cells use.
Box check_tables(const TetraMesh& mesh);

/// Refuses inverted and flat cells, given the extent of the mesh (m).
void check_volumes(const TetraMesh& mesh, double extent);

/// Refuses two vertices nearer than `tolerance` (m): what looks joined there would be torn apart.
void check_coincident(const TetraMesh& mesh, const Box& bounds, double tolerance);

}  // namespace haptic::engine
