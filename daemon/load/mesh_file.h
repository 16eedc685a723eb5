#pragma once
// Tetrahedral meshes from files, exactly as a CellComplex wants them:
//
//     TetGen   name.ele with name.node beside it; comments, counted from 0 or 1; the last attribute of a cell
//              is its region's tag, 0 without attributes
//     Gmsh     name.msh, version 4.1, ASCII or binary; first-order tetrahedra, other elements are left away;
//              the tag is the first physical tag of the volume, else the volume's own
//
// A file is not trusted: what it says it holds is compared with its size before memory is taken for it. A
// file whose cells are all negative (TetGen's own convention) is turned over; one that mixes both is refused.
// Vertices that no cell uses are dropped. Not real-time safe.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cell_complex.h"
#include "load/error.h"

namespace haptic::load {

struct LoadedMesh {
  engine::TetraMesh mesh;             // in the file's unit of length
  std::string file;                   // that holds the cells
  bool binary = false;                // what `places` counts
  std::vector<std::uint64_t> places;  // of each cell in the file: its line, or its byte in a binary file
  std::uint64_t skipped_cells = 0;    // elements of a volume that are no first-order tetrahedra
};

/// By the ending of the name: .ele or .msh. Throws LoadError with file and line, or byte of a binary file.
LoadedMesh read_mesh(const std::filesystem::path& file);

/// The same from memory; the file names are only for errors.
LoadedMesh parse_tetgen(std::string_view nodes, const std::string& node_file, std::string_view cells,
                        const std::string& cell_file);
LoadedMesh parse_gmsh(std::string_view bytes, const std::string& file);

/// Throws LoadError at the place of a cell.
[[noreturn]] void fail_at_cell(const LoadedMesh& mesh, engine::Index cell, const std::string& message);

/// The last step of every reader: orientation, unused vertices, at least one cell.
void finish_mesh(LoadedMesh& loaded);

}  // namespace haptic::load
