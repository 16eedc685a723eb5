#pragma once
// Columns of text that line up.

#include <string>
#include <vector>

namespace haptic::cli {

enum class Align { kLeft, kRight };

struct Column {
  std::string heading;
  Align align = Align::kRight;
};

class Table {
 public:
  explicit Table(std::vector<Column> columns);

  /// One cell for each column.
  void add(std::vector<std::string> row);

  bool empty() const noexcept { return rows_.empty(); }

  /// Heading and rows, each ended by a newline, columns two spaces apart, no space at the end of a line.
  std::string to_string() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// How many columns of a terminal UTF-8 text takes, when each character takes one.
std::size_t width(const std::string& text) noexcept;

}  // namespace haptic::cli
