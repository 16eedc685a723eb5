#include "load/mesh_file.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>

#include "tests/support/tetgen_pair.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

using engine::TetraMesh;

const std::filesystem::path kCorpus = kSource / "tests/fuzz/corpus";
const std::string kNodes = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";

LoadedMesh tetgen(const std::string& name) {
  const std::string both = content_of(kCorpus / "tetgen_fuzz" / name);
  const auto [nodes, cells] = test::split_tetgen_pair(both);
  return parse_tetgen(nodes, "m.node", cells, "m.ele");
}

LoadedMesh gmsh(const std::string& name) {
  return parse_gmsh(content_of(kCorpus / "gmsh_fuzz" / name), "m.msh");
}

double volume(const TetraMesh& mesh, std::size_t cell) {
  const auto& v = mesh.cells[cell];
  const glm::dvec3& o = mesh.vertices[v[0]];
  return glm::dot(mesh.vertices[v[1]] - o, glm::cross(mesh.vertices[v[2]] - o, mesh.vertices[v[3]] - o)) /
         6.0;
}

TEST(TetGen, ReadsNodesCellsAndRegions) {
  const TetraMesh mesh = tetgen("good_from_one.tetgen").mesh;
  // the fifth node is used by no cell
  ASSERT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.vertices[1], glm::dvec3(1.0, 0.0, 0.0));
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_EQ(mesh.tags, std::vector<std::int32_t>{-7});
}

TEST(TetGen, WithoutAttributesIsOneRegionZero) {
  EXPECT_EQ(tetgen("good_plain.tetgen").mesh.tags, std::vector<std::int32_t>{0});
}

TEST(TetGen, TurnsAFileOfNegativeCellsOver) {
  const TetraMesh mesh = tetgen("good_negative.tetgen").mesh;
  EXPECT_DOUBLE_EQ(volume(mesh, 0), 1.0 / 6.0);
  EXPECT_EQ(mesh.tags, std::vector<std::int32_t>{3});
}

TEST(TetGen, TellsTheFirstCellThatDiffersInOrientation) {
  const LoadError error = error_of(
      [] { parse_tetgen(kNodes, "m.node", "3 4 0\n0 0 1 2 3\n# comment\n1 0 2 1 3\n2 0 1 2 3\n", "m.ele"); });
  EXPECT_STREQ(
      error.what(),
      "m.ele:4: cell 1 (counted from 0) is the first cell with negative volume: all cells before it are "
      "the other way round");
}

TEST(TetGen, RefusesACountBeforeItTakesMemoryForIt) {
  // 4e9 vertices would be 96 GB
  const LoadError error =
      error_of([] { parse_tetgen("4000000000 3 0 0\n0 0 0 0\n", "m.node", "", "m.ele"); });
  EXPECT_EQ(error.line(), 1U);
  EXPECT_NE(error.message().find("more than the file has room for"), std::string::npos);
}

TEST(TetGen, LeavesAFlatCellToTheComplexWithItsLine) {
  const std::string flat = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 1 1 0\n";
  const LoadedMesh loaded = parse_tetgen(flat, "m.node", "1 4 0\n0 0 1 2 3\n", "m.ele");
  EXPECT_EQ(loaded.places, std::vector<std::uint64_t>{2});
  EXPECT_STREQ(error_of([&] { fail_at_cell(loaded, 0, "is flat"); }).what(),
               "m.ele:2: cell 0 (counted from 0) is flat");
}

TEST(TetGen, ReadsTheBlockOfTheExamples) {
  const TetraMesh mesh = read_mesh(kSource / "tests/data/examples/l_block.ele").mesh;
  EXPECT_EQ(mesh.vertices.size(), 100U);
  EXPECT_EQ(mesh.cells.size(), 288U);
  EXPECT_EQ(std::count(mesh.tags.begin(), mesh.tags.end(), 1), 18);
  // the cells fill the box from -0.1 to (0.3, 0.3, 0.2): 0.4 * 0.4 * 0.3
  double sum = 0.0;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    EXPECT_GT(volume(mesh, cell), 0.0);
    sum += volume(mesh, cell);
  }
  EXPECT_NEAR(sum, 0.4 * 0.4 * 0.3, 1e-15);
}

TEST(Gmsh, ReadsSparseTagsAndSkipsWhatIsNoTetrahedron) {
  const TetraMesh mesh = gmsh("good_ascii.msh").mesh;
  // node 35 at (9, 9, 9) is used by no cell
  ASSERT_EQ(mesh.vertices.size(), 5U);
  EXPECT_EQ(mesh.vertices[4], glm::dvec3(1.0, 1.0, 1.0));
  ASSERT_EQ(mesh.cells.size(), 2U);
  EXPECT_DOUBLE_EQ(volume(mesh, 0), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(volume(mesh, 1), 2.0 / 6.0);
}

TEST(Gmsh, TakesThePhysicalTagOfAVolumeElseItsOwn) {
  EXPECT_EQ(gmsh("good_ascii.msh").mesh.tags, (std::vector<std::int32_t>{7, 2}));
  EXPECT_EQ(gmsh("good_without_entities.msh").mesh.tags, (std::vector<std::int32_t>{1, 2}));
}

TEST(Gmsh, ReadsTheSameFromBinary) {
  const TetraMesh ascii = gmsh("good_ascii.msh").mesh;
  const LoadedMesh binary = gmsh("good_binary.msh");
  EXPECT_TRUE(binary.binary);
  EXPECT_EQ(binary.mesh.vertices, ascii.vertices);
  EXPECT_EQ(binary.mesh.cells, ascii.cells);
  EXPECT_EQ(binary.mesh.tags, ascii.tags);
}

TEST(Gmsh, TellsWhichVersionItReads) {
  EXPECT_STREQ(
      error_of([] { gmsh("version_2.msh"); }).what(),
      "m.msh:2:1: the version of the format is \"2.2\" (permitted: 4.1, which is gmsh -format msh41)");
  EXPECT_EQ(error_of([] { gmsh("partitioned.msh"); }).message(), "partitioned meshes are not supported");
  EXPECT_NE(error_of([] { gmsh("binary_other_byte_order.msh"); }).message().find("the other byte order"),
            std::string::npos);
}

TEST(Gmsh, TellsTheByteOfABinaryFile) {
  // blocks of 20 bytes and a point, a triangle and a tetrahedron; node 31 is the last, the reader stands
  // behind
  const std::string bytes = content_of(kCorpus / "gmsh_fuzz/binary_node_unknown.msh");
  const std::size_t elements = bytes.find("$Elements\n") + 10;
  const std::size_t behind = elements + 32 + (20 + 16) + (20 + 32) + (20 + 40);
  EXPECT_EQ(error_of([] { gmsh("binary_node_unknown.msh"); }).message(),
            "byte " + std::to_string(behind) + ": node 31 does not exist");
}

TEST(Gmsh, SaysSoIfThereAreOnlyOtherElements) {
  EXPECT_EQ(error_of([] { gmsh("hexahedra_only.msh"); }).message(),
            "has no first-order tetrahedra, but 1 volume elements of other types");
}

TEST(MeshFile, IsKnownByItsName) {
  EXPECT_NE(error_of([] { read_mesh("a.stl"); }).message().find("permitted: .ele, .msh"), std::string::npos);
}

// Whatever is missing at the end, the readers stop with an error that names the file.
class CutMesh : public testing::TestWithParam<const char*> {};

TEST_P(CutMesh, IsAnErrorAtEveryByte) {
  const std::string name = GetParam();
  const std::string whole = content_of(kCorpus / name);
  const auto parse = [&](std::string_view text) {
    const auto [nodes, cells] = test::split_tetgen_pair(text);
    return name.starts_with("gmsh") ? parse_gmsh(text, "m") : parse_tetgen(nodes, "m", cells, "m");
  };
  const TetraMesh mesh = parse(whole).mesh;
  std::size_t accepted = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    // a copy of its own, so that a read beyond the end is seen by AddressSanitizer
    const std::string cut = whole.substr(0, length);
    try {
      EXPECT_EQ(parse(cut).mesh.cells, mesh.cells) << length;
      ++accepted;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file(), "m") << length;
    }
  }
  // only the end of the last line, or a comment behind it, may be missing
  EXPECT_LE(accepted, 8U);
}

INSTANTIATE_TEST_SUITE_P(Corpus, CutMesh,
                         testing::Values("gmsh_fuzz/good_ascii.msh", "gmsh_fuzz/good_binary.msh",
                                         "gmsh_fuzz/good_without_entities.msh",
                                         "tetgen_fuzz/good_plain.tetgen",
                                         "tetgen_fuzz/good_from_one.tetgen"));

}  // namespace
}  // namespace haptic::load
