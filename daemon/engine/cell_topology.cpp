#include "engine/cell_topology.h"

#include <algorithm>

#include "engine/mesh_check.h"
#include "engine/message.h"

namespace haptic::engine {
namespace {

/// A face of one cell, kept with its lowest vertex. `owner` is 4 * cell + i.
struct FaceUse {
  Index middle, high;  // its other vertices
  Index owner;
  bool odd;  // whether the cell sees low, middle, high clockwise
};

FaceUse face_use(const TetraMesh& mesh, Index cell, Index face, Index& low) {
  std::array<Index, 3> v;
  for (std::size_t k = 0; k < 3; ++k) v[k] = mesh.cells[cell][kFaceCorners[face][k]];
  bool odd = false;
  const auto order = [&](Index& a, Index& b) {
    if (a < b) return;
    std::swap(a, b);
    odd = !odd;
  };
  order(v[0], v[1]);
  order(v[1], v[2]);
  order(v[0], v[1]);
  low = v[0];
  return {v[1], v[2], 4 * cell + face, odd};
}

/// The first cell, in their order, that lies on the same side of a face as a cell before it. Of three owners
/// of a face two always do.
class FirstMisfit {
 public:
  explicit FirstMisfit(const TetraMesh& mesh) : mesh_(mesh) {}

  /// All uses of one face, by owner.
  void look_at(std::span<const FaceUse> uses, Index low) {
    std::array<Index, 2> first_on_side{kNone, kNone};
    for (const FaceUse& use : uses) {
      Index& first = first_on_side[use.odd ? 1 : 0];
      const Index cell = use.owner / 4;
      if (first != kNone && cell < cell_) {
        cell_ = cell;
        other_ = first;
        face_ = {low, use.middle, use.high};
        owners_ = uses.size();
      }
      first = std::min(first, cell);
    }
  }

  void refuse() const {
    if (cell_ == kNone) return;
    const auto& vertices = mesh_.cells[cell_];
    if (std::is_permutation(vertices.begin(), vertices.end(), mesh_.cells[other_].begin())) {
      throw MeshError(describe_cell(mesh_, cell_) + " is a duplicate of " + describe_cell(mesh_, other_),
                      cell_);
    }
    const std::string owners = owners_ > 2 ? message(", which has ", owners_, " owners") : "";
    throw MeshError(
        message(describe_cell(mesh_, cell_), " overlaps ", describe_cell(mesh_, other_),
                ": both lie on the same side of face ", face_[0], ", ", face_[1], ", ", face_[2], owners),
        cell_);
  }

 private:
  const TetraMesh& mesh_;
  Index cell_ = kNone;
  Index other_ = kNone;
  std::array<Index, 3> face_{};
  std::size_t owners_ = 0;
};

}  // namespace

std::vector<Index> match_faces(const TetraMesh& mesh) {
  const auto cells = static_cast<Index>(mesh.cells.size());
  Star<FaceUse> by_low = make_star<FaceUse>(mesh.vertices.size(), [&](const auto& visit) {
    for (Index owner = 0; owner < 4 * cells; ++owner) {
      Index low = 0;
      const FaceUse use = face_use(mesh, owner / 4, owner % 4, low);
      visit(low, use);
    }
  });

  std::vector<Index> partner(mesh.cells.size() * 4, kNone);
  FirstMisfit misfit(mesh);
  for (Index low = 0; low < mesh.vertices.size(); ++low) {
    const std::span<FaceUse> uses(by_low.items.data() + by_low.first[low],
                                  by_low.items.data() + by_low.first[low + 1]);
    std::sort(uses.begin(), uses.end(), [](const FaceUse& a, const FaceUse& b) {
      if (a.middle != b.middle) return a.middle < b.middle;
      return a.high != b.high ? a.high < b.high : a.owner < b.owner;
    });
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
      while (last < uses.size() && uses[last].middle == uses[first].middle &&
             uses[last].high == uses[first].high) {
        ++last;
      }
      if (last - first == 1) continue;
      if (last - first == 2 && uses[first].odd != uses[first + 1].odd) {
        partner[uses[first].owner] = uses[first + 1].owner;
        partner[uses[first + 1].owner] = uses[first].owner;
      } else {
        misfit.look_at(uses.subspan(first, last - first), low);
      }
    }
  }
  misfit.refuse();
  return partner;
}

EdgeNumbers number_edges(const TetraMesh& mesh) {
  struct EdgeUse {
    Index high;
    Index owner;  // 6 * cell + e
  };
  const auto cells = static_cast<Index>(mesh.cells.size());
  Star<EdgeUse> by_low = make_star<EdgeUse>(mesh.vertices.size(), [&](const auto& visit) {
    for (Index owner = 0; owner < 6 * cells; ++owner) {
      const auto& ends = kEdgeEnds[owner % 6];
      const auto [low, high] = std::minmax(mesh.cells[owner / 6][ends[0]], mesh.cells[owner / 6][ends[1]]);
      visit(low, EdgeUse{high, owner});
    }
  });

  EdgeNumbers edges;
  edges.of_cell.resize(mesh.cells.size() * 6);
  for (Index low = 0; low < mesh.vertices.size(); ++low) {
    const std::span<EdgeUse> uses(by_low.items.data() + by_low.first[low],
                                  by_low.items.data() + by_low.first[low + 1]);
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
      return a.high != b.high ? a.high < b.high : a.owner < b.owner;
    });
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (i == 0 || uses[i].high != uses[i - 1].high) edges.ends.push_back({low, uses[i].high});
      edges.of_cell[uses[i].owner] = static_cast<Index>(edges.ends.size() - 1);
    }
  }
  return edges;
}

}  // namespace haptic::engine
