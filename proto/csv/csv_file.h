#pragma once
// A CSV file that is written row by row, large and fast. Numbers are the shortest text that reads back as the
// same number; text that has a comma, a quote or a line end is quoted (RFC 4180).

#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace haptic::csv {

/// A file that cannot be written; what() names it and says why.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class CsvFile {
 public:
  /// Makes or empties the file and writes the header. Throws OutputError.
  CsvFile(const std::string& path, std::string_view header);

  CsvFile& add(double value);
  CsvFile& add(std::uint64_t value);
  CsvFile& add(bool value);  // 1 or 0
  CsvFile& add(std::string_view text);
  CsvFile& add(const char* text) { return add(std::string_view(text)); }
  /// x, y, z of a vector, or w, x, y, z of a quaternion; glm's will do.
  template <class Numbers>
  requires requires(const Numbers& numbers) { numbers.x + numbers.y + numbers.z; }
  CsvFile& add(const Numbers& numbers) {
    if constexpr (requires { numbers.w; }) add(numbers.w);
    return add(numbers.x).add(numbers.y).add(numbers.z);
  }

  /// Throws OutputError when what was gathered cannot be written.
  void end_row();

  /// Writes what is left. Only when this has returned is the file complete. Throws OutputError.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  void flush();
  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string buffer_;
};

}  // namespace haptic::csv
