#pragma once
// What is exported: a table for each topic. A CSV file has one; an HDF5 file has a group for each.
//
// Tables of hips, objects and devices begin with the columns that `hapticd simulate` writes. SI units.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace haptic::exporting {

enum class Topic { kHips, kObjects, kDevices, kContacts, kEvents, kStats, kGaps };

enum class Kind {
  kCount,   // std::uint64_t
  kNumber,  // double
  kFlag,    // bool
  kName,    // text that comes again and again: of an object, a state, ...
  kText,    // any other
};

/// One column, or the components of a vector.
struct Column {
  const char* header;  // of a CSV file: "tick", or "x,y,z"
  const char* name;    // of an HDF5 dataset
  Kind kind;
  const char* unit;   // "" where there is none
  const char* frame;  // "world", or "" where there is none
};

std::string_view name_of(Topic topic);

std::span<const Column> columns_of(Topic topic);

/// The components of a column: 1, 3 for a vector, 4 for a quaternion.
std::size_t width_of(const Column& column);

/// Takes the cells of a table row by row, in the order of its columns. Throws csv::OutputError.
class TableWriter {
 public:
  TableWriter() = default;
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;
  virtual ~TableWriter() = default;

  virtual void add(std::uint64_t count) = 0;
  virtual void add(double number) = 0;
  virtual void add(bool flag) = 0;
  virtual void add(std::string_view text) = 0;
  virtual void end_row() = 0;

  /// Only when this has returned is the table whole.
  virtual void close() = 0;
};

}  // namespace haptic::exporting
