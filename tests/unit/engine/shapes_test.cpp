// Shapes against closed forms of their volumes and counts. For every one: it builds (positive, conforming, no
// flat cells), the hull is outside's only, no vertex and no edge gathers many cells.

#include "engine/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/mesh_facts.h"

namespace haptic::engine {
namespace {

using glm::dvec2;
using glm::dvec3;
using test::facts_of;
using test::MeshFacts;

constexpr double kPi = 3.14159265358979323846;

/// Cells that meet at a vertex or an edge: what grading promises, whatever the size of the shape. Outlines
/// may be such that short edges face longer ones, up to the eight or so that one of four times the mean may
/// face.
struct Most {
  std::size_t at_vertex;
  std::size_t at_edge;
};
constexpr Most kGraded{64, 16};
constexpr Most kOfOutline{128, 32};

MeshFacts facts(const TetraMesh& mesh, const Most& most = kGraded) {
  const CellComplex complex = CellComplex::build(mesh);
  // every vertex is used, and the whole is a ball: one part without holes
  for (Index v = 0; v < complex.vertices().size(); ++v) EXPECT_FALSE(complex.cells_of_vertex(v).empty()) << v;
  EXPECT_EQ(complex.vertices().size() + complex.faces().size(),
            complex.edges().size() + complex.cells().size() + 1);
  const MeshFacts facts = facts_of(complex);
  EXPECT_LE(facts.most_at_vertex, most.at_vertex);
  EXPECT_LE(facts.most_at_edge, most.at_edge);
  return facts;
}

/// With air: nothing of the inside on the hull. Without: all of the surface.
void expect_layers(const MeshFacts& facts, bool air) {
  EXPECT_EQ(facts.inside_on_hull, air ? 0U : facts.surface_triangles);
  EXPECT_EQ(facts.outside_cells > 0, air);
}

void expect_near_part(double value, double expected, double part) {
  EXPECT_NEAR(value, expected, part * expected);
}

// box

TEST(BoxMesh, HasTwelveTrianglesAndTheVolumesOfTwoBoxes) {
  const dvec3 size{0.08, 0.03, 0.05};
  for (const double margin : {0.0, 0.0001, 0.02, 1.0}) {
    const MeshFacts box = facts(box_mesh(size, margin));
    expect_layers(box, margin > 0.0);
    EXPECT_EQ(box.inside_cells, 6U);
    EXPECT_EQ(box.surface_triangles, 12U);
    const double inside = size.x * size.y * size.z;
    const dvec3 outer = size + 2.0 * margin;
    expect_near_part(box.inside_volume, inside, 1e-12);
    EXPECT_NEAR(box.outside_volume, outer.x * outer.y * outer.z - inside,
                1e-12 * outer.x * outer.y * outer.z);
  }
}

TEST(BoxMesh, IsCentredOnTheOrigin) {
  const CellComplex complex = CellComplex::build(box_mesh({0.08, 0.03, 0.05}, 0.02));
  EXPECT_EQ(complex.bounds().low, -complex.bounds().high);
  EXPECT_NEAR(glm::distance(complex.bounds().high, dvec3(0.06, 0.035, 0.045)), 0.0, 1e-15);
  const auto tag_at = [&](const dvec3& p) {
    return complex.region_tags()[complex.cells()[complex.locate(p)].region];
  };
  EXPECT_EQ(tag_at({0.039, 0.014, -0.024}), kInside);
  EXPECT_EQ(tag_at({0.041, 0.014, -0.024}), kOutside);
  EXPECT_EQ(tag_at({0.039, 0.016, -0.024}), kOutside);
  EXPECT_EQ(tag_at({0.039, 0.014, -0.026}), kOutside);
}

// icosphere

class IcosphereMesh : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OfEachSize, IcosphereMesh, ::testing::Range(0, 7));

TEST_P(IcosphereMesh, HasItsTrianglesAndGrowsCoarserInward) {
  const int n = GetParam();
  const double radius = 0.02;
  const std::size_t triangles = 20U << (2 * n);
  for (const double margin : {0.0, 0.0005, 0.02}) {
    const MeshFacts sphere = facts(icosphere_mesh(radius, n, margin));
    expect_layers(sphere, margin > 0.0);
    EXPECT_EQ(sphere.surface_triangles, triangles);
    // seven cells for each triangle of the levels n - 1 to 0, and 20 around the centre:
    // 7 * 20 * (4^n - 1) / 3 + 20
    EXPECT_EQ(sphere.inside_cells, 7 * (triangles - 20) / 3 + 20);
    EXPECT_GT(sphere.least_altitude, 1e-3);
  }
}

TEST_P(IcosphereMesh, HasTheVolumeUnderItsTriangles) {
  const int n = GetParam();
  const double radius = 0.02;
  const double margin = 0.01;
  const CellComplex complex = CellComplex::build(icosphere_mesh(radius, n, margin));
  const MeshFacts sphere = facts_of(complex);
  // a triangle with a cell of each region is one of the surface: a cone from it to the centre; so is one of
  // the hull, for inside and outside together
  double inradius = radius;
  double inside = 0.0;
  double together = 0.0;
  for (std::size_t f = 0; f < complex.faces().size(); ++f) {
    const Face& face = complex.faces()[f];
    const auto& v = complex.rims()[f].vertices;
    const auto at = [&](std::size_t k) { return complex.vertices()[v[k]]; };
    const double cone = std::abs(glm::dot(at(0), glm::cross(at(1), at(2)))) / 6.0;
    if (face.cells[1] == kNone) {
      together += cone;
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(glm::length(at(k)), radius + margin, 1e-15);
    } else if (complex.cells()[face.cells[0]].region != complex.cells()[face.cells[1]].region) {
      inside += cone;
      inradius = std::min(inradius, std::abs(face.plane.offset));
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(glm::length(at(k)), radius, 1e-15);
    }
  }
  expect_near_part(sphere.inside_volume, inside, 1e-11);
  expect_near_part(sphere.inside_volume + sphere.outside_volume, together, 1e-11);
  // between the balls that touch its planes and its vertices
  const double ball = 4.0 / 3.0 * kPi * radius * radius * radius;
  EXPECT_LT(inside, ball);
  EXPECT_GT(inside, ball * std::pow(inradius / radius, 3.0));
}

TEST(IcosphereMesh, OfSevenSubdivisionsHasTheCellsOfItsLevels) {
  const std::size_t triangles = 20U << 14;
  EXPECT_EQ(icosphere_mesh(0.02, 7, 0.0).cells.size(), 7 * (triangles - 20) / 3 + 20);
}

TEST(IcosphereMesh, WithoutSubdivisionIsTheIcosahedron) {
  const double radius = 0.03;
  // edge a = R / sin(2 pi / 5), volume 5 (3 + sqrt 5) / 12 a^3
  const double edge = radius / std::sin(2.0 * kPi / 5.0);
  const double volume = 5.0 * (3.0 + std::sqrt(5.0)) / 12.0 * edge * edge * edge;
  expect_near_part(facts(icosphere_mesh(radius, 0, 0.0)).inside_volume, volume, 1e-12);
}

TEST(IcosphereMesh, AirIsNowhereMuchThinnerThanItsMargin) {
  for (const int n : {0, 2, 5}) {
    for (const double margin : {0.002, 0.01, 0.1}) {
      const double radius = 0.02;
      const CellComplex complex = CellComplex::build(icosphere_mesh(radius, n, margin));
      double inradius = std::numeric_limits<double>::infinity();
      for (const Index f : complex.hull_faces()) {
        inradius = std::min(inradius, std::abs(complex.faces()[f].plane.offset));
      }
      const MeshFacts air = facts_of(complex);
      EXPECT_GT(air.outside_cells, 0U);
      // a hull of as many triangles as the surface lies parallel to it, a coarser one outside of the sphere
      const bool is_parallel = complex.hull_faces().size() == 20U << (2 * n);
      const double surface = is_parallel ? inradius * radius / (radius + margin) : radius;
      EXPECT_GE(inradius - surface, (n < 2 ? 0.75 : 0.9) * margin) << n << ", " << margin;
    }
  }
}

// cylinder

class CylinderMesh : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OfEachSize, CylinderMesh,
                         ::testing::Values(3, 4, 5, 6, 7, 8, 9, 12, 13, 32, 48, 63, 100, 1000, 4096));

/// Area of a regular polygon with its corners at `radius`.
double regular_area(int sides, double radius) {
  return 0.5 * sides * radius * radius * std::sin(2.0 * kPi / sides);
}

TEST_P(CylinderMesh, HasTheVolumeOfItsPrism) {
  const int n = GetParam();
  const double radius = 0.02;
  const double height = 0.05;
  for (const double margin : {0.0, 0.001, 0.03}) {
    const MeshFacts cylinder = facts(cylinder_mesh(radius, height, n, margin));
    expect_layers(cylinder, margin > 0.0);
    const double inside = regular_area(n, radius) * height;
    expect_near_part(cylinder.inside_volume, inside, 1e-11);
    if (margin == 0.0) continue;
    // the rim of the air has n sides, or fewer down to 24: its area lies between
    const double outer_height = height + 2.0 * margin;
    const double outer = cylinder.inside_volume + cylinder.outside_volume;
    EXPECT_LT(outer, regular_area(n, radius + margin) * outer_height * (1.0 + 1e-11));
    EXPECT_GT(outer, regular_area(std::min(n, 24), radius + margin) * outer_height * (1.0 - 1e-11));
    if (n < 48) expect_near_part(outer, regular_area(n, radius + margin) * outer_height, 1e-11);
  }
}

TEST(CylinderMesh, HasTwoTrianglesOnEachSideAndItsCapsBesides) {
  // 12 sides: a cap has 12 / 2 * 3 triangles between its two rings and 4 in the middle
  EXPECT_EQ(facts(cylinder_mesh(0.02, 0.05, 12, 0.01)).surface_triangles, 2U * 12U + 2U * (18U + 4U));
  EXPECT_EQ(facts(cylinder_mesh(0.02, 0.05, 3, 0.01)).surface_triangles, 2U * 3U + 2U);
}

// extrusion

struct Outline {
  const char* name;
  std::vector<dvec2> points;
};

std::vector<dvec2> polar(int n, const std::function<double(int, double)>& radius) {
  std::vector<dvec2> points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * kPi * i / n;
    points.push_back(radius(i, angle) * dvec2{std::cos(angle), std::sin(angle)});
  }
  return points;
}

std::vector<dvec2> comb(int teeth) {
  std::vector<dvec2> points;
  for (int i = 0; i < teeth; ++i) {
    points.insert(points.end(),
                  {{0.01 * i, 0.0}, {0.01 * i, 0.03}, {0.01 * i + 0.004, 0.03}, {0.01 * i + 0.004, 0.0}});
  }
  points.insert(points.end(), {{0.01 * teeth, 0.0}, {0.01 * teeth, -0.01}, {0.0, -0.01}});
  return points;
}

const Outline kOutlines[] = {
    {"triangle", {{0.0, 0.0}, {0.05, 0.0}, {0.01, 0.04}}},
    {"letter_l", {{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.02}, {0.02, 0.02}, {0.02, 0.1}, {0.0, 0.1}}},
    {"straight_points",
     {{0.0, 0.0}, {0.05, 0.0}, {0.1, 0.0}, {0.1, 0.03}, {0.1, 0.1}, {0.07, 0.1}, {0.0, 0.1}}},
    {"arrow", {{-0.05, -0.05}, {0.0, -0.04}, {0.05, -0.05}, {0.0, 0.05}}},
    {"star", polar(14, [](int i, double) { return i % 2 == 0 ? 0.05 : 0.015; })},
    {"circle_1000", polar(1000, [](int, double) { return 0.03; })},
    {"wave_1000", polar(1000, [](int, double angle) { return 0.03 + 0.01 * std::sin(7.0 * angle); })},
    {"spikes_4096", polar(4096, [](int i, double) { return i % 2 == 0 ? 0.05 : 0.03; })},
    {"comb", comb(30)},
    {"thin", {{0.0, 0.0}, {0.1, 0.00001}, {0.1, 0.00003}, {0.0, 0.00002}}},
    {"far_away", {{10.0, 5.0}, {10.05, 5.0}, {10.05, 5.05}, {10.02, 5.01}}},
};

class ExtrusionMesh : public ::testing::TestWithParam<Outline> {};
INSTANTIATE_TEST_SUITE_P(Of, ExtrusionMesh, ::testing::ValuesIn(kOutlines),
                         [](const auto& instance) { return std::string(instance.param.name); });

double shoelace(const std::vector<dvec2>& p) {
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const dvec2 a = p[i] - p[0];
    const dvec2 b = p[(i + 1) % p.size()] - p[0];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(0.5 * twice);
}

TEST_P(ExtrusionMesh, HasTheVolumeUnderItsOutlineInABoxOfAir) {
  std::vector<dvec2> points = GetParam().points;
  const double height = 0.04;
  Box box;
  for (const dvec2& p : points) box.add(dvec3(p, 0.0));
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(points.begin(), points.end());
    for (const double margin : {0.0, 0.002, 0.03}) {
      const MeshFacts solid = facts(extrusion_mesh(points, height, margin), kOfOutline);
      expect_layers(solid, margin > 0.0);
      expect_near_part(solid.inside_volume, shoelace(points) * height, 1e-9);
      // two on each side, and at least n - 2 on each cap; more where points were added within
      EXPECT_GE(solid.surface_triangles, 2 * points.size() + 2 * (points.size() - 2));
      if (margin == 0.0) continue;
      const dvec3 air = box.high - box.low + 2.0 * margin;
      expect_near_part(solid.inside_volume + solid.outside_volume, air.x * air.y * (height + 2.0 * margin),
                       1e-9);
    }
  }
}

TEST(ExtrusionMesh, OfASimpleOutlineHasNoTrianglesBeyondThoseItNeeds) {
  const std::vector<dvec2>& l = kOutlines[1].points;
  EXPECT_EQ(facts(extrusion_mesh(l, 0.1, 0.0)).surface_triangles, 2U * 6U + 2U * 4U);
  EXPECT_EQ(facts(extrusion_mesh(l, 0.1, 0.05)).surface_triangles, 2U * 6U + 2U * 4U);
}

TEST(ExtrusionMesh, KeepsTheNotchOfAConcaveOutlineFree) {
  const CellComplex complex = CellComplex::build(extrusion_mesh(kOutlines[1].points, 0.1, 0.05));
  const auto tag_at = [&](const dvec3& p) {
    return complex.region_tags()[complex.cells()[complex.locate(p)].region];
  };
  EXPECT_EQ(tag_at({0.021, 0.021, 0.0}), kOutside);
  EXPECT_EQ(tag_at({0.019, 0.021, 0.049}), kInside);
  EXPECT_EQ(tag_at({0.021, 0.019, -0.049}), kInside);
  EXPECT_EQ(tag_at({0.019, 0.021, 0.051}), kOutside);
}

// what must be refused

void expect_refusal(const std::function<TetraMesh()>& make, const std::string& part) {
  try {
    make();
    ADD_FAILURE() << "made, though " << part;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Shapes, RefuseLengthsThatAreNotPositiveAndFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<dvec2> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const double bad : {0.0, -1.0, nan, inf, -inf}) {
    expect_refusal([&] { return box_mesh({bad, 1.0, 1.0}, 0.1); }, "size.x");
    expect_refusal([&] { return box_mesh({1.0, bad, 1.0}, 0.1); }, "size.y");
    expect_refusal([&] { return box_mesh({1.0, 1.0, bad}, 0.1); }, "size.z");
    expect_refusal([&] { return icosphere_mesh(bad, 1, 0.1); }, "radius");
    expect_refusal([&] { return cylinder_mesh(bad, 1.0, 8, 0.1); }, "radius");
    expect_refusal([&] { return cylinder_mesh(1.0, bad, 8, 0.1); }, "height");
    expect_refusal([&] { return extrusion_mesh(square, bad, 0.1); }, "height");
    if (bad == 0.0) continue;  // no air
    expect_refusal([&] { return box_mesh({1.0, 1.0, 1.0}, bad); }, "air_margin");
    expect_refusal([&] { return icosphere_mesh(1.0, 1, bad); }, "air_margin");
    expect_refusal([&] { return cylinder_mesh(1.0, 1.0, 8, bad); }, "air_margin");
    expect_refusal([&] { return extrusion_mesh(square, 1.0, bad); }, "air_margin");
  }
}

TEST(Shapes, RefuseLengthsTooDifferentForCellsOfSomeThickness) {
  expect_refusal([] { return box_mesh({1.0, 1e-7, 1.0}, 0.0); }, "size.y");
  expect_refusal([] { return box_mesh({1.0, 1.0, 1.0}, 1e-7); }, "air_margin");
  expect_refusal([] { return cylinder_mesh(1e-3, 10.0, 4096, 0.0); }, "segment");
  EXPECT_GT(facts(box_mesh({1.0, 1.1e-6, 1.0}, 1.1e-6)).outside_cells, 0U);
}

TEST(Shapes, RefuseCountsOutOfRange) {
  for (const int bad : {-1, 8, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    expect_refusal([&] { return icosphere_mesh(1.0, bad, 0.0); }, "subdivisions");
  }
  for (const int bad : {-1, 0, 2, 4097, std::numeric_limits<int>::max()}) {
    expect_refusal([&] { return cylinder_mesh(1.0, 1.0, bad, 0.0); }, "segments");
  }
}

TEST(Shapes, RefuseOutlinesThatAreNoSimplePolygons) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_bad = [](const std::vector<dvec2>& outline, const std::string& part) {
    expect_refusal([&] { return extrusion_mesh(outline, 1.0, 0.1); }, "outline");
    expect_refusal([&] { return extrusion_mesh(outline, 1.0, 0.1); }, part);
  };
  expect_bad({}, "0 points");
  expect_bad({{0, 0}, {1, 0}}, "2 points");
  expect_bad(std::vector<dvec2>(4097), "4097 points");
  expect_bad({{0, 0}, {1, 0}, {nan, 1}}, "point 2 is not finite");
  expect_bad({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, "cross");
  expect_bad({{0, 0}, {1, 0}, {1, 1}, {1, 0}}, "points 1 and 3 are at the same place");
  expect_bad({{0, 0}, {1, 0}, {1, 1}, {0, 0}}, "points 0 and 3 are at the same place");
  expect_bad({{0, 0}, {1, 0}, {2, 0}}, "lies on the edge");                                 // no area
  expect_bad({{0, 0}, {2, 0}, {1, 0}, {1, 1}}, "lies on the edge");                         // a spike
  expect_bad({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}, "point 3 lies on the edge");         // touches
  expect_bad({{0, 0}, {2, 0}, {2, 2}, {1, 1e-7}, {0, 2}}, "point 3 lies on the edge");      // nearly
  expect_bad({{0, 0}, {3, 0}, {3, 3}, {1, 3}, {1, -1}, {2, -1}, {2, 2}, {0, 2}}, "cross");  // a loop
}

}  // namespace
}  // namespace haptic::engine
