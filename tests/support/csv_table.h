#pragma once
// Reading back what `hapticd simulate` writes.

#include <cmath>
#include <fstream>
#include <glm/vec3.hpp>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptic::test {

/// Rows of text by column name. Fields in these tests have no commas or quotes.
class CsvTable {
 public:
  explicit CsvTable(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line)) throw std::runtime_error(path + " is empty");
    const std::vector<std::string> names = split(line);
    for (std::size_t i = 0; i < names.size(); ++i) columns_[names[i]] = i;
    while (std::getline(file, line)) rows_.push_back(split(line));
  }

  std::size_t size() const { return rows_.size(); }
  const std::string& text(std::size_t row, const std::string& column) const {
    return rows_.at(row).at(columns_.at(column));
  }
  double number(std::size_t row, const std::string& column) const { return std::stod(text(row, column)); }
  /// The columns <prefix>x, <prefix>y, <prefix>z.
  glm::dvec3 vector(std::size_t row, const std::string& prefix) const {
    return {number(row, prefix + "x"), number(row, prefix + "y"), number(row, prefix + "z")};
  }
  /// The rows of one tick.
  std::vector<std::size_t> rows_of_tick(std::uint64_t tick) const {
    std::vector<std::size_t> found;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (text(row, "tick") == std::to_string(tick)) found.push_back(row);
    }
    return found;
  }

 private:
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    if (!line.empty() && line.back() == ',') fields.emplace_back();
    return fields;
  }

  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace haptic::test
