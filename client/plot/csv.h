#pragma once
// Reads the CSV files that `hapticd simulate` writes: a header, and rows of as many fields (RFC 4180).

#include <cstddef>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace haptic::plot {

class Csv {
 public:
  /// Throws client::Invalid with file and line.
  static Csv read(const std::string& path);
  /// `name` stands for the file in errors.
  static Csv parse(std::istream& text, const std::string& name);

  std::size_t rows() const noexcept { return lines_.size(); }
  bool has(std::string_view column) const noexcept;
  /// Throws client::Invalid if there is none.
  std::size_t column(std::string_view name) const;

  const std::string& text(std::size_t row, std::size_t column) const { return cells_[row * width_ + column]; }
  /// Throws client::Invalid with file, line and column if it is no finite number.
  double number(std::size_t row, std::size_t column) const;

 private:
  std::string name_;
  std::vector<std::string> header_;
  std::size_t width_ = 0;
  std::vector<std::string> cells_;
  std::vector<std::size_t> lines_;  // on which each row begins
};

}  // namespace haptic::plot
