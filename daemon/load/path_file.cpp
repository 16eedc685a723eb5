#include "load/path_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "load/error.h"
#include "load/read_file.h"

namespace haptic::load {
namespace {

constexpr std::array<std::string_view, 8> kColumns = {"time", "x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr double kLargestTime = 1e9;      // s, thirty years
constexpr double kLargestPosition = 1e6;  // m
constexpr double kShortestStep = 1e-9;    // s, what the servo's clock resolves

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

class PathReader {
 public:
  PathReader(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  std::vector<drivers::PathPoint> read() {
    std::string_view line;
    if (!next_line(line)) fail(1, "", "is empty: expected the header time,x,y,z[,qw,qx,qy,qz]");
    read_header(line);
    std::vector<drivers::PathPoint> path;
    while (next_line(line)) {
      if (trimmed(line).empty()) {
        // blank lines may only end a file: one within it may be a row that was lost
        if (trimmed_is_empty(rest_)) break;
        fail(1, "", "is a blank line");
      }
      path.push_back(row(line));
      if (path.size() > 1 && !(path.back().time - path[path.size() - 2].time >= kShortestStep)) {
        fail(1, "time", "does not ascend by at least 1e-09 s from the row before");
      }
    }
    if (path.empty()) fail(1, "", "has no rows after the header");
    return path;
  }

 private:
  [[noreturn]] void fail(std::size_t column, std::string_view field, const std::string& message) const {
    throw LoadError({file_, std::max(line_, 1U), static_cast<std::uint32_t>(column), std::string(field)},
                    message);
  }

  static bool trimmed_is_empty(std::string_view text) {
    return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
  }

  bool next_line(std::string_view& line) {
    if (rest_.empty()) return false;
    ++line_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return true;
  }

  void read_header(std::string_view line) {
    std::size_t count = 0;
    for (std::size_t start = 0; start <= line.size(); ++count) {
      const std::size_t end = std::min(line.find(',', start), line.size());
      if (count >= kColumns.size() || trimmed(line.substr(start, end - start)) != kColumns[count]) {
        fail(start + 1, "", "expected the header time,x,y,z or time,x,y,z,qw,qx,qy,qz");
      }
      start = end + 1;
    }
    if (count != 4 && count != 8) fail(1, "", "expected the header time,x,y,z or time,x,y,z,qw,qx,qy,qz");
    fields_ = count;
  }

  drivers::PathPoint row(std::string_view line) const {
    std::array<double, 8> values{};
    std::size_t count = 0;
    std::size_t quaternion_column = 1;
    for (std::size_t start = 0; start <= line.size(); ++count) {
      const std::size_t end = std::min(line.find(',', start), line.size());
      if (count >= fields_) fail(start + 1, "", "has more than " + std::to_string(fields_) + " fields");
      if (count == 4) quaternion_column = start + 1;
      values[count] = number(line.substr(start, end - start), start + 1, count);
      start = end + 1;
    }
    if (count < fields_) {
      fail(line.size() + 1, kColumns[count],
           "is missing: the row has " + std::to_string(count) + " of " + std::to_string(fields_) + " fields");
    }
    drivers::PathPoint point{values[0], {values[1], values[2], values[3]}, {1.0, 0.0, 0.0, 0.0}};
    if (fields_ == 8) {
      const double length = std::sqrt(values[4] * values[4] + values[5] * values[5] + values[6] * values[6] +
                                      values[7] * values[7]);
      if (!(length > 1e-6)) fail(quaternion_column, "qw", "the quaternion is zero");
      point.orientation = {values[4] / length, values[5] / length, values[6] / length, values[7] / length};
    }
    return point;
  }

  double number(std::string_view field, std::size_t column, std::size_t index) const {
    const std::string_view text = trimmed(field);
    if (text.empty()) fail(column, kColumns[index], "is empty: expected a number");
    column += static_cast<std::size_t>(text.data() - field.data());
    double value = 0.0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec == std::errc::result_out_of_range || result.ptr != text.data() + text.size() ||
        result.ec != std::errc{} || !std::isfinite(value)) {
      fail(column, kColumns[index], in_quotes(text) + " is not a finite number");
    }
    const bool is_time = index == 0;
    if (is_time && std::abs(value) > kLargestTime) {
      fail(column, "time", std::string(text) + " s is out of range (permitted: -1e9 to 1e9)");
    }
    if (!is_time && std::abs(value) > kLargestPosition) {
      fail(column, kColumns[index], std::string(text) + " is out of range (permitted: -1e6 to 1e6)");
    }
    return value;
  }

  std::string_view rest_;
  std::string file_;
  std::uint32_t line_ = 0;
  std::size_t fields_ = 4;
};

}  // namespace

std::vector<drivers::PathPoint> parse_path(std::string_view text, const std::string& file) {
  return PathReader(text, file).read();
}

std::vector<drivers::PathPoint> read_path(const std::filesystem::path& file) {
  return parse_path(read_file(file, kMaxTextBytes), file.string());
}

}  // namespace haptic::load
