#pragma once
// Tables in an HDF5 file: a group for each, and in it a dataset for each column, compressed in chunks that
// grow with the rows. h5py and MATLAB (h5read) read them.
//
//     /objects                 attributes: rows
//     /objects/time            (rows)     float64; attributes unit, columns
//     /objects/position        (rows, 3)  float64; attributes unit, frame, columns = "x,y,z"
//     /objects/object          (rows)     uint32, index into
//     /objects/object_names    (names)    text; named by the attribute "names" of /objects/object
//     /hips/slipping           (rows)     uint8, 0 or 1
//     /events/message          (rows)     text
//
// Text is UTF-8 of variable length.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "client/export/tables.h"

namespace haptic::exporting {

/// An identifier of the HDF5 library, given back by its own function. Moved, not copied.
class Hdf5Id {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Id() = default;
  Hdf5Id(std::int64_t id, Close closer) noexcept : id_(id), close_(closer) {}
  Hdf5Id(Hdf5Id&& other) noexcept;
  Hdf5Id& operator=(Hdf5Id&& other) noexcept;
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  ~Hdf5Id();

  std::int64_t get() const noexcept { return id_; }
  /// False if the library could not write what it still had.
  bool close() noexcept;

 private:
  std::int64_t id_ = -1;
  Close close_ = nullptr;
};

class Hdf5File {
 public:
  /// Makes or empties the file. All here throws csv::OutputError.
  explicit Hdf5File(std::string path);

  /// An attribute of the whole file.
  void describe(const std::string& name, const std::string& text);
  void describe(const std::string& name, double number);

  /// A table that is still empty. To be closed before the file is.
  std::unique_ptr<TableWriter> add_table(const std::string& name, std::span<const Column> columns);

  void close();

 private:
  std::string path_;
  Hdf5Id file_;
};

}  // namespace haptic::exporting
