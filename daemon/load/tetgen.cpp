// TetGen's .node and .ele: lines of numbers, each file opened by a line of counts.

#include <cmath>
#include <limits>

#include "load/mesh_file.h"
#include "load/text_cursor.h"

namespace haptic::load {
namespace {

using engine::Index;

constexpr double kLargestCoordinate = 1e12;  // in the file's unit; volumes stay far from overflow
constexpr std::int64_t kMostAttributes = 1000;

struct NodeList {
  std::vector<glm::dvec3> vertices;
  std::int64_t first = 0;  // number of the first node: 0 or 1
};

// a count that the file tells of itself, refused if so many lines cannot follow
std::int64_t count_of(TextCursor& cursor, const char* what, std::size_t shortest_line) {
  const auto count = cursor.number<std::int64_t>(what);
  if (count < 1) cursor.fail(std::string(what) + " is " + std::to_string(count) + " (permitted: at least 1)");
  if (static_cast<std::uint64_t>(count) > (cursor.remaining() + 1) / shortest_line) {
    cursor.fail(std::string(what) + " is " + std::to_string(count) + ", more than the file has room for");
  }
  return count;
}

std::int64_t bounded(TextCursor& cursor, const char* what, std::int64_t most) {
  const auto value = cursor.number<std::int64_t>(what);
  if (value < 0 || value > most) {
    cursor.fail(std::string(what) + " is " + std::to_string(value) + " (permitted: 0 to " +
                std::to_string(most) + ")");
  }
  return value;
}

double coordinate(TextCursor& cursor, const char* what) {
  const auto value = cursor.number<double>(what);
  if (std::abs(value) > kLargestCoordinate) {
    cursor.fail(std::string(what) + " is out of range (permitted: -1e12 to 1e12)");
  }
  return value;
}

void next_record(TextCursor& cursor, std::int64_t done, std::int64_t count, const char* what) {
  if (cursor.next_line()) return;
  cursor.fail("the file ends after " + std::to_string(done) + " of " + std::to_string(count) + " " + what);
}

NodeList read_nodes(TextCursor cursor) {
  NodeList list;
  if (!cursor.next_line()) cursor.fail("is empty: expected the line of counts");
  // the shortest line of a node: "0 0 0 0\n"
  const std::int64_t count = count_of(cursor, "the number of nodes", 8);
  const auto dimension = cursor.number<std::int64_t>("the dimension");
  if (dimension != 3) cursor.fail("the dimension is " + std::to_string(dimension) + " (permitted: 3)");
  const std::int64_t attributes =
      cursor.at_end_of_line() ? 0 : bounded(cursor, "the number of attributes", kMostAttributes);
  const std::int64_t markers = cursor.at_end_of_line() ? 0 : bounded(cursor, "the number of markers", 1);
  cursor.expect_end_of_line("a line of counts");

  list.vertices.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    next_record(cursor, i, count, "nodes");
    const auto number = cursor.number<std::int64_t>("the number of a node");
    if (i == 0) {
      if (number != 0 && number != 1) cursor.fail("the first node has a number that is neither 0 nor 1");
      list.first = number;
    }
    if (number != list.first + i) cursor.fail("nodes are not numbered one after the other");
    const double x = coordinate(cursor, "x");
    const double y = coordinate(cursor, "y");
    const double z = coordinate(cursor, "z");
    list.vertices.emplace_back(x, y, z);
    for (std::int64_t k = 0; k < attributes + markers; ++k) cursor.number<double>("an attribute or a marker");
    cursor.expect_end_of_line("the first line tells");
  }
  if (cursor.next_line()) cursor.fail("has more lines than the first one tells");
  return list;
}

// TetGen writes a region as a real number
std::int32_t region_tag(TextCursor& cursor) {
  const auto value = cursor.number<double>("the region of a cell");
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<std::int32_t>::max()) {
    cursor.fail("the region of a cell is not a whole number of 32 bits");
  }
  return static_cast<std::int32_t>(value);
}

}  // namespace

LoadedMesh parse_tetgen(std::string_view nodes, const std::string& node_file, std::string_view cells,
                        const std::string& cell_file) {
  NodeList list = read_nodes(TextCursor(nodes, node_file));
  const auto node_count = static_cast<std::int64_t>(list.vertices.size());
  LoadedMesh loaded;
  loaded.file = cell_file;
  loaded.mesh.vertices = std::move(list.vertices);

  TextCursor cursor(cells, cell_file);
  if (!cursor.next_line()) cursor.fail("is empty: expected the line of counts");
  // the shortest line of a cell: "0 0 1 2 3\n"
  const std::int64_t count = count_of(cursor, "the number of cells", 10);
  const auto corners = cursor.number<std::int64_t>("the number of nodes of a cell");
  if (corners != 4) {
    cursor.fail("cells have " + std::to_string(corners) +
                " nodes (permitted: 4, which is TetGen without -o2)");
  }
  const std::int64_t attributes =
      cursor.at_end_of_line() ? 0 : bounded(cursor, "the number of attributes", kMostAttributes);
  cursor.expect_end_of_line("a line of counts");

  loaded.mesh.cells.reserve(static_cast<std::size_t>(count));
  loaded.mesh.tags.reserve(static_cast<std::size_t>(count));
  loaded.places.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    next_record(cursor, i, count, "cells");
    loaded.places.push_back(cursor.line());
    const auto number = cursor.number<std::int64_t>("the number of a cell");
    if (number != list.first + i) {
      cursor.fail("cells are not numbered one after the other from " + std::to_string(list.first) +
                  ", as the nodes are");
    }
    std::array<Index, 4> cell{};
    for (Index& vertex : cell) {
      const auto node = cursor.number<std::int64_t>("a node of a cell");
      if (node < list.first || node - list.first >= node_count) {
        cursor.fail("node " + std::to_string(node) + " does not exist (permitted: " +
                    std::to_string(list.first) + " to " + std::to_string(list.first + node_count - 1) + ")");
      }
      vertex = static_cast<Index>(node - list.first);
    }
    loaded.mesh.cells.push_back(cell);
    std::int32_t tag = 0;
    for (std::int64_t k = 0; k < attributes; ++k) tag = region_tag(cursor);
    loaded.mesh.tags.push_back(tag);
    cursor.expect_end_of_line("the first line tells");
  }
  if (cursor.next_line()) cursor.fail("has more lines than the first one tells");
  finish_mesh(loaded);
  return loaded;
}

}  // namespace haptic::load
