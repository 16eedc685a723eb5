// Gmsh's MSH 4.1. ASCII and binary hold the same records; one reader takes them from either input.
//
//     $MeshFormat   version, 0 or 1 (binary), 8; binary: the integer 1 in the writer's byte order
//     $Entities     points, curves, surfaces, volumes with their physical tags (may be missing)
//     $Nodes        blocks of node tags, then of coordinates
//     $Elements     blocks of elements of one type: tag, node tags

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <unordered_map>

#include "load/mesh_file.h"
#include "load/text_cursor.h"

namespace haptic::load {
namespace {

using engine::Index;
using engine::kNone;

constexpr double kLargestCoordinate = 1e12;  // in the file's unit; volumes stay far from overflow
constexpr int kTetrahedron = 4;

/// Nodes of an element of each type, 0 for types that are not known.
std::size_t nodes_of_type(int type) {
  constexpr std::size_t kNodes[] = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                    8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
  if (type == 92) return 64;
  if (type == 93) return 125;
  return type >= 0 && type < static_cast<int>(std::size(kNodes)) ? kNodes[type] : 0;
}

/// Records as lines of text.
class AsciiInput {
 public:
  static constexpr bool kBinary = false;
  explicit AsciiInput(TextCursor cursor) : cursor_(std::move(cursor)) {}

  [[noreturn]] void fail(const std::string& message) const { cursor_.fail(message); }
  std::uint64_t place() const noexcept { return cursor_.line(); }

  /// Whether so many more records can follow.
  bool has_room(std::uint64_t records, std::size_t shortest_line, std::size_t) const noexcept {
    return records <= (cursor_.remaining() + 1) / shortest_line;
  }
  void begin_record() {
    if (!cursor_.next_line()) fail("the file ends too early");
  }
  void end_record() { cursor_.expect_end_of_line("this record should have"); }
  template <class Number>
  Number get(const char* what) {
    return cursor_.number<Number>(what);
  }
  void skip_records(std::uint64_t count, std::size_t) {
    for (; count > 0; --count) {
      begin_record();
      cursor_.skip_line();
    }
  }

  /// The next word that stands alone in a line, empty at the end.
  std::string keyword() {
    if (!cursor_.next_line()) return "";
    std::string word(cursor_.word());
    cursor_.advance(word.size());
    cursor_.expect_end_of_line("a section's name alone");
    return word;
  }
  void skip_to(const std::string& end) {
    const std::string_view rest(cursor_.position(), cursor_.remaining());
    const std::size_t found = rest.find("\n" + end);
    if (found == std::string_view::npos) fail("the file ends before " + end);
    cursor_.advance(found + 1);
  }

 private:
  TextCursor cursor_;
};

/// Records as bytes.
class BinaryInput {
 public:
  static constexpr bool kBinary = true;
  BinaryInput(std::string_view bytes, std::size_t at, std::string file)
      : bytes_(bytes), at_(at), file_(std::move(file)) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw LoadError({file_, 0, 0, ""}, "byte " + std::to_string(at_) + ": " + message);
  }
  std::uint64_t place() const noexcept { return at_; }

  bool has_room(std::uint64_t records, std::size_t, std::size_t bytes_each) const noexcept {
    return records <= (bytes_.size() - at_) / bytes_each;
  }
  void begin_record() const noexcept {}
  void end_record() const noexcept {}
  template <class Number>
  Number get(const char* what) {
    Number value{};
    if (bytes_.size() - at_ < sizeof value)
      fail(std::string("the file ends where ") + what + " should stand");
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(value)) fail(std::string(what) + " is not a finite number");
    }
    at_ += sizeof value;
    return value;
  }
  void skip_records(std::uint64_t count, std::size_t nodes) {
    const std::size_t each = 8 * (1 + nodes);
    if (!has_room(count, 0, each)) fail("the file ends within the elements that it tells of");
    at_ += static_cast<std::size_t>(count) * each;
  }

  std::string keyword() {
    while (at_ < bytes_.size() && (bytes_[at_] == '\n' || bytes_[at_] == '\r' || bytes_[at_] == ' ')) ++at_;
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string word(bytes_.substr(at_, end - at_));
    while (!word.empty() && (word.back() == '\r' || word.back() == ' ')) word.pop_back();
    at_ = std::min(end + 1, bytes_.size());
    return word;
  }
  void skip_to(const std::string& end) {
    const std::size_t found = bytes_.find(end, at_);
    if (found == std::string_view::npos) fail("the file ends before " + end);
    at_ = found;
  }

 private:
  std::string_view bytes_;
  std::size_t at_;
  std::string file_;
};

/// From a node's tag to its vertex. Tags may be sparse; most files use nearly all of them.
class NodeTags {
 public:
  void reserve(std::uint64_t nodes, std::uint64_t largest) {
    if (largest <= 16 * nodes + 1024) dense_.assign(static_cast<std::size_t>(largest) + 1, kNone);
  }
  /// False if the tag is taken, or too large.
  bool add(std::uint64_t tag, Index vertex) {
    if (dense_.empty()) return sparse_.emplace(tag, vertex).second;
    if (tag >= dense_.size() || dense_[tag] != kNone) return false;
    dense_[tag] = vertex;
    return true;
  }
  Index find(std::uint64_t tag) const {
    if (!dense_.empty()) return tag < dense_.size() ? dense_[tag] : kNone;
    const auto found = sparse_.find(tag);
    return found != sparse_.end() ? found->second : kNone;
  }

 private:
  std::vector<Index> dense_;
  std::unordered_map<std::uint64_t, Index> sparse_;
};

template <class Input>
class GmshReader {
 public:
  GmshReader(Input input, const std::string& file) : in_(std::move(input)) {
    loaded_.file = file;
    loaded_.binary = Input::kBinary;
  }

  LoadedMesh read() {
    for (std::string name = in_.keyword(); !name.empty(); name = in_.keyword()) {
      if (name[0] != '$')
        in_.fail("expected the name of a section, such as $Nodes, found " + in_quotes(name));
      if (name == "$PartitionedEntities") in_.fail("partitioned meshes are not supported");
      const std::string end = "$End" + name.substr(1);
      if (name == "$Entities") {
        once(name, have_entities_, !have_elements_);
        entities();
      } else if (name == "$Nodes") {
        once(name, have_nodes_, true);
        nodes();
      } else if (name == "$Elements") {
        once(name, have_elements_, have_nodes_);
        elements();
      } else {
        in_.skip_to(end);
      }
      const std::string found = in_.keyword();
      if (found != end) in_.fail("expected " + end + ", found " + in_quotes(found));
    }
    if (!have_nodes_) in_.fail("has no section $Nodes");
    if (!have_elements_) in_.fail("has no section $Elements");
    finish_mesh(loaded_);
    return std::move(loaded_);
  }

 private:
  void once(const std::string& name, bool& have, bool in_order) {
    if (have) in_.fail("the section " + name + " is there twice");
    if (!in_order) in_.fail("the section " + name + " is out of order: $Entities, $Nodes, $Elements");
    have = true;
  }

  void entities() {
    in_.begin_record();
    std::array<std::uint64_t, 4> counts{};
    for (auto& count : counts) count = in_.template get<std::uint64_t>("a number of entities");
    in_.end_record();
    for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
      for (std::uint64_t i = 0; i < counts[dimension]; ++i) entity(dimension);
    }
  }

  // a point has its coordinates, anything else a bounding box and the entities that bound it
  void entity(std::size_t dimension) {
    in_.begin_record();
    const int tag = in_.template get<int>("an entity's tag");
    for (int k = dimension == 0 ? 3 : 6; k > 0; --k) in_.template get<double>("an entity's coordinate");
    const auto physical = in_.template get<std::uint64_t>("the number of physical tags");
    for (std::uint64_t k = 0; k < physical; ++k) {
      const int physical_tag = in_.template get<int>("a physical tag");
      if (dimension == 3 && k == 0) region_of_volume_[tag] = physical_tag;
    }
    if (dimension > 0) {
      const auto bounding = in_.template get<std::uint64_t>("the number of bounding entities");
      for (std::uint64_t k = 0; k < bounding; ++k) in_.template get<int>("a bounding entity");
    }
    in_.end_record();
  }

  void nodes() {
    in_.begin_record();
    const auto blocks = in_.template get<std::uint64_t>("the number of blocks");
    const auto count = in_.template get<std::uint64_t>("the number of nodes");
    in_.template get<std::uint64_t>("the smallest node tag");
    const auto largest = in_.template get<std::uint64_t>("the largest node tag");
    in_.end_record();
    // the shortest node in text: "1\n0 0 0\n"
    if (!in_.has_room(count, 8, 32)) {
      in_.fail("the number of nodes is " + std::to_string(count) + ", more than the file has room for");
    }
    loaded_.mesh.vertices.reserve(static_cast<std::size_t>(count));
    node_tags_.reserve(count, largest);
    for (std::uint64_t i = 0; i < blocks; ++i) node_block(count);
    if (loaded_.mesh.vertices.size() != count) {
      in_.fail("blocks hold " + std::to_string(loaded_.mesh.vertices.size()) + " nodes, $Nodes tells of " +
               std::to_string(count));
    }
  }

  void node_block(std::uint64_t total) {
    in_.begin_record();
    const int dimension = in_.template get<int>("a block's dimension");
    in_.template get<int>("a block's entity");
    const int parametric = in_.template get<int>("whether a block is parametric");
    const auto count = in_.template get<std::uint64_t>("a block's number of nodes");
    in_.end_record();
    if (dimension < 0 || dimension > 3) in_.fail("a block's dimension is out of range (permitted: 0 to 3)");
    if (parametric != 0 && parametric != 1) in_.fail("parametric is out of range (permitted: 0 or 1)");
    std::vector<glm::dvec3>& vertices = loaded_.mesh.vertices;
    if (count > total - vertices.size()) in_.fail("blocks hold more nodes than $Nodes tells of");

    for (std::uint64_t i = 0; i < count; ++i) {
      in_.begin_record();
      const auto tag = in_.template get<std::uint64_t>("a node's tag");
      if (tag == 0 || !node_tags_.add(tag, static_cast<Index>(vertices.size() + i))) {
        in_.fail("node tag " + std::to_string(tag) + " is zero, given twice or above the largest told");
      }
      in_.end_record();
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      in_.begin_record();
      glm::dvec3 position;
      for (int axis = 0; axis < 3; ++axis) {
        position[axis] = in_.template get<double>("a coordinate");
        if (std::abs(position[axis]) > kLargestCoordinate) {
          in_.fail("a coordinate is out of range (permitted: -1e12 to 1e12)");
        }
      }
      for (int k = 0; k < parametric * dimension; ++k) in_.template get<double>("a parameter");
      in_.end_record();
      vertices.push_back(position);
    }
  }

  void elements() {
    in_.begin_record();
    const auto blocks = in_.template get<std::uint64_t>("the number of blocks");
    const auto count = in_.template get<std::uint64_t>("the number of elements");
    in_.template get<std::uint64_t>("the smallest element tag");
    in_.template get<std::uint64_t>("the largest element tag");
    in_.end_record();
    // the shortest element is a point: "1 1\n"
    if (!in_.has_room(count, 4, 16)) {
      in_.fail("the number of elements is " + std::to_string(count) + ", more than the file has room for");
    }
    std::uint64_t left = count;
    for (std::uint64_t i = 0; i < blocks; ++i) left -= element_block(left);
    if (left != 0)
      in_.fail("blocks hold " + std::to_string(left) + " elements fewer than $Elements tells of");
  }

  std::uint64_t element_block(std::uint64_t most) {
    in_.begin_record();
    const int dimension = in_.template get<int>("a block's dimension");
    const int entity = in_.template get<int>("a block's entity");
    const int type = in_.template get<int>("a block's element type");
    const auto count = in_.template get<std::uint64_t>("a block's number of elements");
    in_.end_record();
    if (count > most) in_.fail("blocks hold more elements than $Elements tells of");
    if (type != kTetrahedron) {
      const std::size_t nodes = nodes_of_type(type);
      if (nodes == 0) in_.fail("the element type " + std::to_string(type) + " is not known");
      in_.skip_records(count, nodes);
      if (dimension == 3) loaded_.skipped_cells += count;
      return count;
    }
    if (dimension != 3) in_.fail("tetrahedra stand in an entity that is no volume");
    const auto region = region_of_volume_.find(entity);
    const std::int32_t tag = region != region_of_volume_.end() ? region->second : entity;
    for (std::uint64_t i = 0; i < count; ++i) tetrahedron(tag);
    return count;
  }

  void tetrahedron(std::int32_t tag) {
    in_.begin_record();
    loaded_.places.push_back(in_.place());
    in_.template get<std::uint64_t>("an element's tag");
    std::array<Index, 4> cell{};
    for (Index& vertex : cell) {
      const auto node = in_.template get<std::uint64_t>("a node of an element");
      vertex = node_tags_.find(node);
      if (vertex == kNone) in_.fail("node " + std::to_string(node) + " does not exist");
    }
    in_.end_record();
    loaded_.mesh.cells.push_back(cell);
    loaded_.mesh.tags.push_back(tag);
  }

  Input in_;
  LoadedMesh loaded_;
  NodeTags node_tags_;
  std::map<int, std::int32_t> region_of_volume_;
  bool have_entities_ = false;
  bool have_nodes_ = false;
  bool have_elements_ = false;
};

}  // namespace

LoadedMesh parse_gmsh(std::string_view bytes, const std::string& file) {
  TextCursor cursor(bytes, file);
  if (!cursor.next_line() || cursor.word() != "$MeshFormat") cursor.fail("expected $MeshFormat at the start");
  cursor.advance(cursor.word().size());
  if (!cursor.next_line()) cursor.fail("the file ends within $MeshFormat");
  const std::string version(cursor.word());
  if (version != "4.1") {
    cursor.fail("the version of the format is " + in_quotes(version) +
                " (permitted: 4.1, which is gmsh -format msh41)");
  }
  cursor.advance(version.size());
  const int kind = cursor.number<int>("0 (ASCII) or 1 (binary)");
  if (kind != 0 && kind != 1) cursor.fail("expected 0 (ASCII) or 1 (binary)");
  const int data_size = cursor.number<int>("the size of a number");
  if (data_size != 8) cursor.fail("the size of a number is not 8 (permitted: 8)");
  cursor.expect_end_of_line("the version, the kind and the size");

  if (kind == 0) {
    AsciiInput input(cursor);
    if (input.keyword() != "$EndMeshFormat") input.fail("expected $EndMeshFormat");
    return GmshReader<AsciiInput>(std::move(input), file).read();
  }
  const auto line_end = static_cast<std::size_t>(cursor.position() - bytes.data());
  BinaryInput input(bytes, std::min(bytes.find('\n', line_end), bytes.size() - 1) + 1, file);
  const auto one = input.get<std::uint32_t>("the integer 1");
  if (one == 0x01000000U) input.fail("was written on a machine with the other byte order");
  if (one != 1) input.fail("expected the integer 1 after the version");
  if (input.keyword() != "$EndMeshFormat") input.fail("expected $EndMeshFormat");
  return GmshReader<BinaryInput>(std::move(input), file).read();
}

}  // namespace haptic::load
