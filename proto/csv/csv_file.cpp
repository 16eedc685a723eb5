#include "proto/csv/csv_file.h"

#include <cerrno>
#include <charconv>
#include <system_error>

namespace haptic::csv {

namespace {

constexpr std::size_t kBufferBytes = 1 << 20;
constexpr std::size_t kLongestNumber = 32;  // -1.7976931348623157e+308 has 24

template <class Number>
void append(std::string& buffer, Number value) {
  char text[kLongestNumber];
  const auto result = std::to_chars(text, text + sizeof text, value);
  buffer.append(text, result.ptr);
  buffer.push_back(',');
}

}  // namespace

CsvFile::CsvFile(const std::string& path, std::string_view header)
    : path_(path), file_(std::fopen(path.c_str(), "wbe")) {
  if (!file_) fail();
  // rows are gathered here: a second buffer would only copy them
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  buffer_.reserve(kBufferBytes + kBufferBytes / 16);
  buffer_.append(header).push_back('\n');
}

CsvFile& CsvFile::add(double value) {
  append(buffer_, value);
  return *this;
}

CsvFile& CsvFile::add(std::uint64_t value) {
  append(buffer_, value);
  return *this;
}

CsvFile& CsvFile::add(bool value) {
  buffer_.append(value ? "1," : "0,");
  return *this;
}

CsvFile& CsvFile::add(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    buffer_.append(text);
  } else {
    buffer_.push_back('"');
    for (const char c : text) buffer_.append(c == '"' ? 2 : 1, c);
    buffer_.push_back('"');
  }
  buffer_.push_back(',');
  return *this;
}

void CsvFile::end_row() {
  // the comma after the last field becomes the end of the row
  buffer_.back() = '\n';
  if (buffer_.size() >= kBufferBytes) flush();
}

void CsvFile::close() {
  flush();
  // some file systems tell of a full disk only now
  if (std::fclose(file_.release()) != 0) fail();
}

void CsvFile::flush() {
  if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) fail();
  buffer_.clear();
}

void CsvFile::fail() const {
  throw OutputError(path_ + ": cannot be written: " + std::generic_category().message(errno));
}

}  // namespace haptic::csv
