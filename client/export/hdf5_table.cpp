#include "client/export/hdf5_table.h"

#include <hdf5.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "proto/csv/csv_file.h"

namespace haptic::exporting {
namespace {

constexpr hsize_t kChunkRows = 4096;
constexpr unsigned kDeflate = 4;  // more costs much time and saves little

// what the library itself says is a trace of calls for its developers
[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw csv::OutputError(path + ": " + what);
}

Hdf5Id checked(hid_t id, Hdf5Id::Close close, const std::string& path) {
  if (id < 0) {
    fail(path, "cannot be written");
  }
  return {id, close};
}

void check(herr_t status, const std::string& path) {
  if (status < 0) {
    fail(path, "cannot be written");
  }
}

Hdf5Id text_type(const std::string& path) {
  Hdf5Id type = checked(H5Tcopy(H5T_C_S1), H5Tclose, path);
  check(H5Tset_size(type.get(), H5T_VARIABLE), path);
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), path);
  return type;
}

void write_attribute(hid_t where, const std::string& name, hid_t type, const void* value,
                     const std::string& path) {
  const Hdf5Id space = checked(H5Screate(H5S_SCALAR), H5Sclose, path);
  const Hdf5Id attribute =
      checked(H5Acreate2(where, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path);
  check(H5Awrite(attribute.get(), type, value), path);
}

void write_attribute(hid_t where, const std::string& name, const std::string& text, const std::string& path) {
  const char* const value = text.c_str();
  write_attribute(where, name, text_type(path).get(), static_cast<const void*>(&value), path);
}

// a column that grows; rows are gathered until a chunk of them is there
class Dataset {
 public:
  Dataset(hid_t group, const Column& column, const std::string& path)
      : kind_(column.kind), width_(width_of(column)), name_(column.name), path_(path), group_(group) {
    type_ = kind_ == Kind::kText ? text_type(path) : Hdf5Id(H5Tcopy(memory_type()), H5Tclose);
    dataset_ = create(name_, type_.get(), width_);
    write_attribute(dataset_.get(), "columns", column.header, path_);
    if (*column.unit != '\0') {
      write_attribute(dataset_.get(), "unit", column.unit, path_);
    }
    if (*column.frame != '\0') {
      write_attribute(dataset_.get(), "frame", column.frame, path_);
    }
    if (kind_ == Kind::kName) {
      write_attribute(dataset_.get(), "names", name_ + "_names", path_);
    }
  }

  std::size_t width() const noexcept { return width_; }

  void add(std::uint64_t count) { counts_.push_back(count); }
  void add(double number) { numbers_.push_back(number); }
  void add(bool flag) { flags_.push_back(flag ? 1 : 0); }
  void add(std::string_view text) {
    if (kind_ == Kind::kText) {
      texts_.emplace_back(text);
      return;
    }
    const auto [known, is_new] = names_.try_emplace(std::string(text), names_.size());
    codes_.push_back(static_cast<std::uint32_t>(known->second));
  }

  void end_row() {
    if (++waiting_ == kChunkRows) {
      flush();
    }
  }

  void close() {
    flush();
    if (kind_ == Kind::kName) {
      write_names();
    }
    if (!dataset_.close()) {
      fail(path_, "cannot be written");
    }
  }

 private:
  hid_t memory_type() const {
    switch (kind_) {
      case Kind::kCount:
        return H5T_NATIVE_UINT64;
      case Kind::kNumber:
        return H5T_NATIVE_DOUBLE;
      case Kind::kFlag:
        return H5T_NATIVE_UINT8;
      default:
        return H5T_NATIVE_UINT32;
    }
  }

  int rank() const noexcept { return width_ > 1 ? 2 : 1; }

  Hdf5Id create(const std::string& name, hid_t type, std::size_t width) {
    const std::array<hsize_t, 2> size{0, width};
    const std::array<hsize_t, 2> most{H5S_UNLIMITED, width};
    const std::array<hsize_t, 2> chunk{kChunkRows, width};
    const Hdf5Id space = checked(H5Screate_simple(rank(), size.data(), most.data()), H5Sclose, path_);
    const Hdf5Id plan = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path_);
    check(H5Pset_chunk(plan.get(), rank(), chunk.data()), path_);
    check(H5Pset_shuffle(plan.get()), path_);
    check(H5Pset_deflate(plan.get(), kDeflate), path_);
    return checked(H5Dcreate2(group_, name.c_str(), type, space.get(), H5P_DEFAULT, plan.get(), H5P_DEFAULT),
                   H5Dclose, path_);
  }

  void flush() {
    if (waiting_ == 0) {
      return;
    }
    std::vector<const char*> pointers;
    pointers.reserve(texts_.size());
    for (const std::string& text : texts_) {
      pointers.push_back(text.c_str());
    }
    append(dataset_.get(), rows_, waiting_, type_.get(), values(pointers));
    rows_ += waiting_;
    waiting_ = 0;
    counts_.clear();
    numbers_.clear();
    flags_.clear();
    codes_.clear();
    texts_.clear();
  }

  const void* values(const std::vector<const char*>& texts) const {
    switch (kind_) {
      case Kind::kCount:
        return counts_.data();
      case Kind::kNumber:
        return numbers_.data();
      case Kind::kFlag:
        return flags_.data();
      case Kind::kName:
        return codes_.data();
      case Kind::kText:
        break;
    }
    return static_cast<const void*>(texts.data());
  }

  void append(hid_t dataset, hsize_t first, hsize_t rows, hid_t type, const void* data) {
    const std::array<hsize_t, 2> size{first + rows, width_};
    check(H5Dset_extent(dataset, size.data()), path_);
    const std::array<hsize_t, 2> start{first, 0};
    const std::array<hsize_t, 2> count{rows, width_};
    const Hdf5Id file_space = checked(H5Dget_space(dataset), H5Sclose, path_);
    check(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
          path_);
    const Hdf5Id memory_space = checked(H5Screate_simple(rank(), count.data(), nullptr), H5Sclose, path_);
    check(H5Dwrite(dataset, type, memory_space.get(), file_space.get(), H5P_DEFAULT, data), path_);
  }

  // in the order of their codes
  void write_names() {
    std::vector<const char*> names(names_.size());
    for (const auto& [name, code] : names_) {
      names[code] = name.c_str();
    }
    const Hdf5Id type = text_type(path_);
    const Hdf5Id dataset = create(name_ + "_names", type.get(), 1);
    if (!names.empty()) {
      append(dataset.get(), 0, names.size(), type.get(), static_cast<const void*>(names.data()));
    }
  }

  Kind kind_;
  std::size_t width_;
  std::string name_;
  std::string path_;
  hid_t group_;
  Hdf5Id type_;
  Hdf5Id dataset_;
  hsize_t rows_ = 0;
  hsize_t waiting_ = 0;
  // of the rows that wait; only the one of the kind is used
  std::vector<std::uint64_t> counts_;
  std::vector<double> numbers_;
  std::vector<std::uint8_t> flags_;
  std::vector<std::uint32_t> codes_;
  std::vector<std::string> texts_;
  std::map<std::string, std::size_t> names_;
};

class Hdf5Table : public TableWriter {
 public:
  Hdf5Table(Hdf5Id group, std::span<const Column> columns, const std::string& path)
      : path_(path), group_(std::move(group)) {
    datasets_.reserve(columns.size());
    for (const Column& column : columns) {
      datasets_.emplace_back(group_.get(), column, path);
    }
  }

  void add(std::uint64_t count) override { next().add(count); }
  void add(double number) override { next().add(number); }
  void add(bool flag) override { next().add(flag); }
  void add(std::string_view text) override { next().add(text); }

  void end_row() override {
    for (Dataset& dataset : datasets_) {
      dataset.end_row();
    }
    ++rows_;
    column_ = 0;
    component_ = 0;
  }

  void close() override {
    for (Dataset& dataset : datasets_) {
      dataset.close();
    }
    write_attribute(group_.get(), "rows", H5T_NATIVE_UINT64, &rows_, path_);
  }

 private:
  Dataset& next() {
    Dataset& dataset = datasets_.at(column_);
    if (++component_ == dataset.width()) {
      component_ = 0;
      ++column_;
    }
    return dataset;
  }

  std::string path_;
  Hdf5Id group_;
  std::vector<Dataset> datasets_;
  std::size_t column_ = 0;  // of the next cell
  std::size_t component_ = 0;
  std::uint64_t rows_ = 0;
};

}  // namespace

Hdf5Id::Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Hdf5Id& Hdf5Id::operator=(Hdf5Id&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(close_, other.close_);
  return *this;
}

Hdf5Id::~Hdf5Id() { close(); }

bool Hdf5Id::close() noexcept {
  const std::int64_t id = std::exchange(id_, -1);
  return id < 0 || close_(id) >= 0;
}

Hdf5File::Hdf5File(std::string path) : path_(std::move(path)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  errno = 0;
  const hid_t file = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0) {
    fail(path_,
         "cannot be written" + (errno == 0 ? std::string() : ": " + std::generic_category().message(errno)));
  }
  file_ = Hdf5Id(file, H5Fclose);
}

void Hdf5File::describe(const std::string& name, const std::string& text) {
  write_attribute(file_.get(), name, text, path_);
}

void Hdf5File::describe(const std::string& name, double number) {
  write_attribute(file_.get(), name, H5T_NATIVE_DOUBLE, &number, path_);
}

std::unique_ptr<TableWriter> Hdf5File::add_table(const std::string& name, std::span<const Column> columns) {
  Hdf5Id group =
      checked(H5Gcreate2(file_.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path_);
  return std::make_unique<Hdf5Table>(std::move(group), columns, path_);
}

void Hdf5File::close() {
  if (H5Fflush(file_.get(), H5F_SCOPE_LOCAL) < 0 || !file_.close()) {
    fail(path_, "cannot be written");
  }
}

}  // namespace haptic::exporting
