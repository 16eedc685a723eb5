// The tables of a complex against what defines them, on grids with flat and concave regions, on shuffled
// copies and on cells near the limit of flatness; and every kind of mesh that must be refused.

#include "engine/cell_complex.h"

#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <set>
#include <string>

#include "engine/constants.h"
#include "tests/support/meshes.h"

namespace haptic::engine {
namespace {

using glm::dvec3;

/// Unit vectors and side tests of a mesh of size 1 are exact to some roundings.
constexpr double kRounding = 1e-14;

/// A mesh whose thinnest cell is only ten times as thick as permitted: a plate of obtuse slivers.
TetraMesh nearly_flat() {
  TetraMesh mesh = test::thin_plate(1.6e-8, 3);
  for (dvec3& v : mesh.vertices) v.x += 0.31 * v.y;  // no right angles
  return mesh;
}

/// One cell that is nearly a line: its faces are flat obtuse triangles, whose planes are hardest to get
/// right.
TetraMesh nearly_straight() {
  const dvec3 along{0.83, 0.41, 0.37};
  const dvec3 across{1.1e-6, -1.7e-6, -0.6e-6};
  return {{{0, 0, 0}, along, 0.37 * along + across, 0.61 * along + glm::cross(along, across)},
          {{0, 1, 2, 3}},
          {0}};
}

struct NamedMesh {
  const char* name;
  TetraMesh (*mesh)();
};

const NamedMesh kMeshes[] = {
    {"corner", [] { return test::corner_cell(); }},
    {"cube", [] { return test::kuhn_cube(3); }},
    {"l_block", [] { return test::l_block(2); }},
    {"shuffled", [] { return test::shuffled(test::l_block(2), 7); }},
    {"far_away",
     [] {
       TetraMesh mesh = test::l_block(1);
       for (dvec3& v : mesh.vertices) v += dvec3{100.0, -50.0, 20.0};
       return mesh;
     }},
    {"nearly_flat", nearly_flat},
    {"nearly_straight", nearly_straight},
};

class Tables : public ::testing::TestWithParam<NamedMesh> {
 protected:
  const TetraMesh mesh_ = GetParam().mesh();
  const CellComplex complex_ = CellComplex::build(mesh_);
  const double extent_ = glm::distance(complex_.bounds().low, complex_.bounds().high);
  const double rounding_ =
      kRounding * (extent_ + glm::length(complex_.bounds().low) + glm::length(complex_.bounds().high));

  const dvec3& at(Index vertex) const { return complex_.vertices()[vertex]; }
};

INSTANTIATE_TEST_SUITE_P(Of, Tables, ::testing::ValuesIn(kMeshes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(Tables, KeepTheNumbersOfVerticesAndCells) {
  ASSERT_EQ(complex_.vertices().size(), mesh_.vertices.size());
  ASSERT_EQ(complex_.cells().size(), mesh_.cells.size());
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
    EXPECT_EQ(complex_.vertices()[v], mesh_.vertices[v]);
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    EXPECT_EQ(complex_.cells()[c].vertices, mesh_.cells[c]);
    EXPECT_EQ(complex_.region_tags()[complex_.cells()[c].region], mesh_.tags[c]);
  }
}

TEST_P(Tables, PlanesPassThroughTheirThreeVerticesAndHaveTheFourthInside) {
  for (const Cell& cell : complex_.cells()) {
    for (int i = 0; i < 4; ++i) {
      const auto lane = static_cast<std::size_t>(i);
      EXPECT_NEAR(glm::length(dvec3(cell.normal_x[lane], cell.normal_y[lane], cell.normal_z[lane])), 1.0,
                  kRounding);
      for (std::size_t k = 0; k < 4; ++k) {
        const double side = cell.side(i, at(cell.vertices[k]));
        if (k == lane) {
          EXPECT_GE(side, 0.5 * kFlatCell * extent_);
        } else {
          EXPECT_LE(std::abs(side), rounding_);
        }
      }
    }
  }
}

TEST_P(Tables, LanesAreTheFacesPlaneOrItsNegativeToTheBit) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  for (Index c = 0; c < complex_.cells().size(); ++c) {
    const Cell& cell = complex_.cells()[c];
    for (std::size_t i = 0; i < 4; ++i) {
      const Face& face = complex_.faces()[cell.faces[i]];
      ASSERT_TRUE(face.cells[0] == c || face.cells[1] == c);
      const double sign = face.cells[0] == c ? 1.0 : -1.0;
      EXPECT_EQ(bits(cell.normal_x[i]), bits(sign * face.plane.normal.x));
      EXPECT_EQ(bits(cell.normal_y[i]), bits(sign * face.plane.normal.y));
      EXPECT_EQ(bits(cell.normal_z[i]), bits(sign * face.plane.normal.z));
      EXPECT_EQ(bits(cell.offset[i]), bits(sign * face.plane.offset));
      EXPECT_EQ(cell.neighbours[i], face.cells[0] == c ? face.cells[1] : face.cells[0]);
      const auto& rim = complex_.rims()[cell.faces[i]].vertices;
      std::set<Index> expected(cell.vertices.begin(), cell.vertices.end());
      expected.erase(cell.vertices[i]);
      EXPECT_EQ(std::set<Index>(rim.begin(), rim.end()), expected);
    }
  }
}

TEST_P(Tables, RimsLieInTheirFacesAndLookInward) {
  for (std::size_t f = 0; f < complex_.faces().size(); ++f) {
    const Face& face = complex_.faces()[f];
    const FaceRim& rim = complex_.rims()[f];
    EXPECT_LT(face.cells[0], face.cells[1]);
    const dvec3 turn =
        glm::cross(at(rim.vertices[1]) - at(rim.vertices[0]), at(rim.vertices[2]) - at(rim.vertices[0]));
    EXPECT_GT(glm::dot(turn, face.plane.normal), 0.0);  // counter-clockwise seen from cells[0]
    for (std::size_t k = 0; k < 3; ++k) {
      const Plane& inward = rim.inward[k];
      const Index from = rim.vertices[k];
      const Index to = rim.vertices[(k + 1) % 3];
      EXPECT_NEAR(glm::length(inward.normal), 1.0, kRounding);
      EXPECT_NEAR(glm::dot(inward.normal, face.plane.normal), 0.0, kRounding);
      EXPECT_LE(std::abs(inward.side(at(from))), rounding_);
      EXPECT_LE(std::abs(inward.side(at(to))), rounding_);
      EXPECT_GE(inward.side(at(rim.vertices[(k + 2) % 3])), 0.5 * kFlatCell * extent_);
      const Edge& edge = complex_.edges()[rim.edges[k]];
      EXPECT_EQ(edge.ends, (std::array<Index, 2>{std::min(from, to), std::max(from, to)}));
    }
  }
}

TEST_P(Tables, EdgesPointFromTheLowerVertexToTheHigher) {
  for (const Edge& edge : complex_.edges()) {
    EXPECT_LT(edge.ends[0], edge.ends[1]);
    EXPECT_EQ(edge.origin, at(edge.ends[0]));
    EXPECT_NEAR(glm::length(edge.direction), 1.0, kRounding);
    EXPECT_LE(glm::distance(edge.origin + edge.length * edge.direction, at(edge.ends[1])), rounding_);
  }
}

TEST_P(Tables, StarsListExactlyWhatTouchesAFeature) {
  std::vector<std::set<Index>> cells_of_vertex(mesh_.vertices.size());
  std::vector<std::set<Index>> faces_of_vertex(mesh_.vertices.size());
  std::vector<std::set<Index>> edges_of_vertex(mesh_.vertices.size());
  std::vector<std::set<Index>> cells_of_edge(complex_.edges().size());
  std::vector<std::set<Index>> faces_of_edge(complex_.edges().size());
  for (Index e = 0; e < complex_.edges().size(); ++e) {
    for (const Index v : complex_.edges()[e].ends) edges_of_vertex[v].insert(e);
  }
  for (Index f = 0; f < complex_.faces().size(); ++f) {
    for (const Index v : complex_.rims()[f].vertices) faces_of_vertex[v].insert(f);
    for (const Index e : complex_.rims()[f].edges) faces_of_edge[e].insert(f);
  }
  for (Index c = 0; c < complex_.cells().size(); ++c) {
    for (const Index v : complex_.cells()[c].vertices) cells_of_vertex[v].insert(c);
    for (const Index f : complex_.cells()[c].faces) {
      for (const Index e : complex_.rims()[f].edges) cells_of_edge[e].insert(c);
    }
  }
  const auto equal = [](std::span<const Index> star, const std::set<Index>& expected) {
    return std::equal(star.begin(), star.end(), expected.begin(), expected.end());  // ascending, once each
  };
  for (Index v = 0; v < mesh_.vertices.size(); ++v) {
    EXPECT_TRUE(equal(complex_.cells_of_vertex(v), cells_of_vertex[v]));
    EXPECT_TRUE(equal(complex_.faces_of_vertex(v), faces_of_vertex[v]));
    EXPECT_TRUE(equal(complex_.edges_of_vertex(v), edges_of_vertex[v]));
  }
  for (Index e = 0; e < complex_.edges().size(); ++e) {
    EXPECT_TRUE(equal(complex_.faces_of_edge(e), faces_of_edge[e]));
    ASSERT_EQ(complex_.cells_of_edge(e).size(), cells_of_edge[e].size());
    for (const EdgeCell& use : complex_.cells_of_edge(e)) {
      EXPECT_TRUE(cells_of_edge[e].contains(use.cell));
      // the two planes that contain the edge are opposite the two vertices that do not end it
      EXPECT_NE(use.planes[0], use.planes[1]);
      for (const std::uint8_t plane : use.planes) {
        const Index opposite = complex_.cells()[use.cell].vertices[plane];
        EXPECT_NE(opposite, complex_.edges()[e].ends[0]);
        EXPECT_NE(opposite, complex_.edges()[e].ends[1]);
      }
    }
  }
}

TEST_P(Tables, HullIsTheFacesWithOneCellInAscendingOrder) {
  std::vector<Index> expected;
  for (Index f = 0; f < complex_.faces().size(); ++f) {
    if (complex_.faces()[f].cells[1] == kNone) expected.push_back(f);
  }
  EXPECT_TRUE(std::equal(complex_.hull_faces().begin(), complex_.hull_faces().end(), expected.begin(),
                         expected.end()));
  // 4 faces of each cell; an inner one belongs to two
  EXPECT_EQ(2 * complex_.faces().size(), 4 * complex_.cells().size() + expected.size());
}

TEST_P(Tables, EveryCellIsLocatedAtItsCentre) {
  for (Index c = 0; c < complex_.cells().size(); ++c) {
    const auto& v = complex_.cells()[c].vertices;
    EXPECT_EQ(complex_.locate(0.25 * (at(v[0]) + at(v[1]) + at(v[2]) + at(v[3]))), c);
  }
}

TEST_P(Tables, EulerCharacteristicIsThatOfABall) {
  EXPECT_EQ(complex_.vertices().size() + complex_.faces().size(),
            complex_.edges().size() + complex_.cells().size() + 1);
}

TEST(CellComplex, PointsOnASharedFeatureBelongToTheLowestCell) {
  const CellComplex complex = CellComplex::build(test::shuffled(test::kuhn_cube(2), 5));
  for (std::size_t f = 0; f < complex.faces().size(); ++f) {
    const auto& v = complex.rims()[f].vertices;
    const dvec3 centre =
        (complex.vertices()[v[0]] + complex.vertices()[v[1]] + complex.vertices()[v[2]]) / 3.0;
    EXPECT_EQ(complex.locate(centre), complex.faces()[f].cells[0]);  // the lower of the two
  }
  for (Index v = 0; v < complex.vertices().size(); ++v) {
    EXPECT_EQ(complex.locate(complex.vertices()[v]), complex.cells_of_vertex(v)[0]);
  }
}

TEST(CellComplex, HullIsAsThickAsTheTolerance) {
  const CellComplex complex = CellComplex::build(test::corner_cell());
  const double eps = complex.tolerance();
  EXPECT_DOUBLE_EQ(eps, kLengthTolerance * std::sqrt(3.0));  // the diagonal of a unit cube
  EXPECT_EQ(complex.locate({0.3, 0.3, -0.9 * eps}), 0U);
  EXPECT_EQ(complex.locate({0.3, 0.3, -1.1 * eps}), kNone);
  EXPECT_EQ(complex.locate({0.3, 0.3, 0.3}), 0U);
  EXPECT_EQ(complex.locate({0.4, 0.4, 0.4}), kNone);
}

TEST(CellComplex, NothingIsLocatedWhereThereIsNoNumber) {
  const CellComplex complex = CellComplex::build(test::corner_cell());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complex.locate({nan, 0.1, 0.1}), kNone);
  EXPECT_EQ(complex.locate({0.1, inf, 0.1}), kNone);
  EXPECT_EQ(complex.locate({0.1, 0.1, -inf}), kNone);
}

TEST(CellComplex, RegionTagsAreKeptAscendingAndOnce) {
  TetraMesh mesh = test::kuhn_cube(1);
  mesh.tags = {7, -3, 7, std::numeric_limits<std::int32_t>::max(), -3, 7};
  const CellComplex complex = CellComplex::build(mesh);
  const std::vector<std::int32_t> expected{-3, 7, std::numeric_limits<std::int32_t>::max()};
  EXPECT_TRUE(std::equal(complex.region_tags().begin(), complex.region_tags().end(), expected.begin(),
                         expected.end()));
  for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(expected[complex.cells()[c].region], mesh.tags[c]);
}

TEST(CellComplex, UnusedVerticesAreIgnored) {
  TetraMesh mesh = test::corner_cell();
  mesh.vertices.emplace_back(1e6, 0.0, 0.0);
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);  // at the place of a used one
  const CellComplex complex = CellComplex::build(mesh);
  EXPECT_EQ(complex.bounds().high, dvec3(1.0));
  EXPECT_TRUE(complex.cells_of_vertex(4).empty());
  EXPECT_TRUE(complex.edges_of_vertex(5).empty());
}

TEST(CellComplex, HullMayTouchItselfInAVertexOrAnEdge) {
  // two cells that share the vertex 0 only, and two that share the edge 0-1 only
  TetraMesh vertex = test::corner_cell();
  vertex.vertices.insert(vertex.vertices.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  vertex.cells.push_back({0, 5, 4, 6});
  vertex.tags.push_back(0);
  const CellComplex at_vertex = CellComplex::build(vertex);
  EXPECT_EQ(at_vertex.cells_of_vertex(0).size(), 2U);
  EXPECT_EQ(at_vertex.hull_faces().size(), 8U);

  TetraMesh edge = test::corner_cell();
  edge.vertices.insert(edge.vertices.end(), {{0, -1, 0}, {0, 0, -1}});
  edge.cells.push_back({0, 1, 4, 5});
  edge.tags.push_back(0);
  const CellComplex at_edge = CellComplex::build(edge);
  EXPECT_EQ(at_edge.cells_of_edge(0).size(), 2U);
  EXPECT_EQ(at_edge.faces_of_edge(0).size(), 4U);
}

TEST(CellComplex, BuildingTwiceGivesTheSameTables) {
  const TetraMesh mesh = test::shuffled(test::l_block(2), 11);
  const CellComplex a = CellComplex::build(mesh);
  const CellComplex b = CellComplex::build(mesh);
  ASSERT_EQ(a.faces().size(), b.faces().size());
  for (std::size_t f = 0; f < a.faces().size(); ++f) {
    EXPECT_EQ(a.faces()[f].cells, b.faces()[f].cells);
    EXPECT_EQ(a.faces()[f].plane.offset, b.faces()[f].plane.offset);
    EXPECT_EQ(a.rims()[f].edges, b.rims()[f].edges);
  }
}

TEST(CellComplex, BytesCountEveryTable) {
  const CellComplex complex = CellComplex::build(test::kuhn_cube(2));
  // 48 cells of 192 B, 120 faces of 40 + 120 B, 27 vertices of 24 B and 98 edges of 64 B are most of it
  const std::size_t records = complex.cells().size_bytes() + complex.faces().size_bytes() +
                              complex.rims().size_bytes() + complex.edges().size_bytes() +
                              complex.vertices().size_bytes();
  // stars: 4 B for each cell, face, edge of each vertex (4, 3, 2 of them) and each face of an edge (3), 8 B
  // for each of the 6 edges of a cell, 4 B for each first
  const std::size_t stars =
      4 * (4 * complex.cells().size() + (3 + 3) * complex.faces().size() + 2 * complex.edges().size()) +
      std::size_t{8} * 6 * complex.cells().size() +
      4 * (3 * (complex.vertices().size() + 1) + 2 * (complex.edges().size() + 1));
  EXPECT_GT(complex.bytes(), records + stars);
  EXPECT_LT(complex.bytes(), records + stars + 100 * (complex.cells().size() + complex.hull_faces().size()));
}

TEST(CellComplex, HundredThousandCellsTakeASecondAtMost) {
  // n log n: some 0.2 s; anything quadratic would take minutes
  const TetraMesh mesh = test::shuffled(test::kuhn_cube(26), 3);  // 6 x 26^3 = 105 456 cells
  const auto start = std::chrono::steady_clock::now();
  const CellComplex complex = CellComplex::build(mesh);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_EQ(complex.cells().size(), 105456U);
}

/// A vertex and an edge that all cells share: the bad cases for anything that walks stars while building.
TEST(CellComplex, CellsAllAroundOneEdgeAreBuiltAsFast) {
  TetraMesh mesh{{{0, 0, -1}, {0, 0, 1}}, {}, {}};
  constexpr Index kAround = 20000;
  for (Index i = 0; i < kAround; ++i) {
    const double angle = 6.283185307179586 * i / kAround;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    mesh.cells.push_back({0, 1, 2 + i, 2 + (i + 1) % kAround});
    mesh.tags.push_back(0);
  }
  const auto start = std::chrono::steady_clock::now();
  const CellComplex complex = CellComplex::build(mesh);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_EQ(complex.cells_of_edge(0).size(), kAround);
}

// What must be refused.

struct Refusal {
  Index cell = 0;
  std::string what;
};

Refusal refusal_of(const TetraMesh& mesh) {
  try {
    CellComplex::build(mesh);
  } catch (const MeshError& error) {
    return {error.cell, error.what()};
  }
  return {0, "it was built"};
}

void expect_refusal(const TetraMesh& mesh, Index cell, const std::string& part) {
  const Refusal refusal = refusal_of(mesh);
  EXPECT_EQ(refusal.cell, cell) << refusal.what;
  EXPECT_NE(refusal.what.find(part), std::string::npos) << refusal.what;
}

/// Two cells on both sides of the triangle 1, 2, 3.
TetraMesh two_cells() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {{0, 1, 2, 3}, {4, 1, 3, 2}}, {0, 1}};
}

TEST(CellComplexRefuses, AMeshWithoutCells) { expect_refusal({{{0, 0, 0}}, {}, {}}, kNone, "no cells"); }

TEST(CellComplexRefuses, TablesOfDifferentSizes) {
  TetraMesh mesh = two_cells();
  mesh.tags.pop_back();
  expect_refusal(mesh, kNone, "2 cells but 1 tags");
}

TEST(CellComplexRefuses, AnIndexOutOfRange) {
  TetraMesh mesh = two_cells();
  mesh.cells[1][2] = 5;
  expect_refusal(mesh, 1, "vertex 5 is out of range; the mesh has 5 vertices");
  mesh.cells[1][2] = kNone;
  expect_refusal(mesh, 1, "vertex 4294967295 is out of range");
}

TEST(CellComplexRefuses, ARepeatedVertex) {
  TetraMesh mesh = two_cells();
  mesh.cells[1] = {4, 1, 3, 1};
  expect_refusal(mesh, 1, "cell 1 (vertices 4, 1, 3, 1): vertex 1 is repeated");
}

TEST(CellComplexRefuses, CoordinatesThatAreNoFiniteNumbers) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      TetraMesh mesh = two_cells();
      mesh.vertices[4][axis] = bad;
      expect_refusal(mesh, 1, "vertex 4 is not finite");
    }
  }
}

TEST(CellComplexRefuses, ExtentsThatCannotBeComputedWith) {
  for (const double factor : {1e-300, 1e-12, 1e12, 1e300}) {
    TetraMesh mesh = two_cells();
    for (dvec3& v : mesh.vertices) v *= factor;
    expect_refusal(mesh, kNone, "extent");
  }
}

TEST(CellComplexRefuses, AMeshTooFarFromItsOrigin) {
  TetraMesh mesh = two_cells();
  for (dvec3& v : mesh.vertices) v.y += 1e6;
  expect_refusal(mesh, kNone, "from its origin");
}

TEST(CellComplexRefuses, AnInvertedCell) {
  TetraMesh mesh = two_cells();
  std::swap(mesh.cells[1][0], mesh.cells[1][1]);
  // altitude of (1,1,1) over the plane x + y + z = 1: 2 / sqrt(3) = 1.1547; the smallest is that over the
  // largest face, which is this one (sides of sqrt(2))
  expect_refusal(mesh, 1, "cell 1 (vertices 1, 4, 3, 2) is inverted: its smallest altitude is -1.1547 m");
}

TEST(CellComplexRefuses, AFlatCell) {
  for (const double height : {0.0, 1e-9, -1e-9}) {
    TetraMesh mesh = two_cells();
    mesh.vertices[4] = dvec3{1.0, 1.0, 1.0} * ((1.0 + height) / 3.0);
    expect_refusal(mesh, 1, "is flat");
  }
}

TEST(CellComplexRefuses, ADuplicateCell) {
  TetraMesh mesh = two_cells();
  mesh.cells.push_back({1, 4, 2, 3});  // cell 1, its vertices in another order of the same sense
  mesh.tags.push_back(0);
  expect_refusal(mesh, 2, "cell 2 (vertices 1, 4, 2, 3) is a duplicate of cell 1");
}

TEST(CellComplexRefuses, CellsOnTheSameSideOfAFace) {
  TetraMesh mesh = two_cells();
  mesh.vertices[4] = {-1, -1, -1};  // now both lie below the triangle 1, 2, 3
  mesh.cells[1] = {4, 1, 2, 3};
  expect_refusal(mesh, 1, "overlaps cell 0 (vertices 0, 1, 2, 3): both lie on the same side of face 1, 2, 3");
}

TEST(CellComplexRefuses, AFaceWithThreeOwners) {
  TetraMesh mesh = two_cells();
  mesh.vertices.emplace_back(2, 2, 2);
  mesh.cells.push_back({5, 1, 3, 2});
  mesh.tags.push_back(0);
  expect_refusal(mesh, 2, "face 1, 2, 3, which has 3 owners");
}

TEST(CellComplexRefuses, TheFirstOfManyBadCells) {
  TetraMesh mesh = test::kuhn_cube(4);
  mesh.cells.push_back(mesh.cells[50]);
  mesh.cells.push_back(mesh.cells[3]);
  mesh.tags.resize(mesh.cells.size(), 0);
  expect_refusal(mesh, 384, "is a duplicate of cell 50");
}

TEST(CellComplexRefuses, VerticesAtOnePlace) {
  // the second cell has three vertices of its own where those of the first are: nothing would join the two
  TetraMesh mesh = two_cells();
  mesh.vertices.insert(mesh.vertices.end(), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  mesh.cells[1] = {4, 5, 7, 6};
  expect_refusal(mesh, 1, "is at the place of vertex");
}

TEST(CellComplexRefuses, VerticesNearerThanTheToleranceWhateverTheDirection) {
  const double eps = kLengthTolerance * std::sqrt(3.0);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const dvec3 direction = glm::normalize(dvec3{uniform(random), uniform(random), uniform(random)});
    TetraMesh mesh = two_cells();
    mesh.vertices[1] += 1e-6 * dvec3{uniform(random), uniform(random), uniform(random)};
    mesh.vertices.push_back(mesh.vertices[1] + 0.9 * eps * direction);
    mesh.cells[1] = {4, 5, 3, 2};
    expect_refusal(mesh, 1, "vertex 5 is at the place of vertex 1");
    mesh.vertices.back() += 0.2 * eps * direction;
    EXPECT_EQ(refusal_of(mesh).what, "it was built");
  }
}

TEST(CellComplexRefuses, ManyBadCellsQuickly) {
  // all on one side of one face: the worst case for anything that compares pairs
  TetraMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}};
  constexpr Index kCells = 200000;
  for (Index i = 0; i < kCells; ++i) {
    mesh.vertices.emplace_back(0.3, 0.3, 1.0 + 1e-5 * i);
    mesh.cells.push_back({0, 1, 2, 3 + i});
    mesh.tags.push_back(0);
  }
  const auto start = std::chrono::steady_clock::now();
  expect_refusal(mesh, 1, "overlaps cell 0");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace haptic::engine
