#include "client/plot/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <utility>

#include "client/lib/error.h"

namespace haptic::plot {
namespace {

constexpr std::size_t kFieldLimit = 4096;        // bytes
constexpr std::size_t kColumnLimit = 256;        // what simulate writes has 22 at most
constexpr std::size_t kCellLimit = 100'000'000;  // some gigabytes

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& message) {
  v1::Error error;
  error.set_code(v1::Error::INVALID);
  error.set_file(file);
  error.set_line(static_cast<std::uint32_t>(line));
  error.set_message(message);
  throw client::Invalid(error);
}

// reads records and counts lines
class Records {
 public:
  Records(std::istream& text, const std::string& name) : text_(text), name_(name) {}

  std::size_t line() const noexcept { return begin_; }

  /// The fields of the next record; false at the end.
  bool next(std::vector<std::string>& fields) {
    fields.clear();
    begin_ = line_;
    if (text_.peek() == std::istream::traits_type::eof()) {
      return false;
    }
    fields.emplace_back();
    for (int c = text_.get(); c != std::istream::traits_type::eof(); c = text_.get()) {
      if (c == '\n') {
        ++line_;
        break;
      }
      if (c == '"' && fields.back().empty()) {
        quoted(fields.back());
      } else if (c == ',') {
        if (fields.size() == kColumnLimit) {
          fail(name_, begin_, "a row has more than " + std::to_string(kColumnLimit) + " fields");
        }
        fields.emplace_back();
      } else if (c != '\r' || text_.peek() != '\n') {
        add(fields.back(), c);
      }
    }
    return true;
  }

 private:
  void add(std::string& field, int c) {
    if (field.size() == kFieldLimit) {
      fail(name_, line_, "a field is longer than " + std::to_string(kFieldLimit) + " bytes");
    }
    field += static_cast<char>(c);
  }

  // up to the closing quote; a doubled one stands for itself
  void quoted(std::string& field) {
    for (int c = text_.get(); c != std::istream::traits_type::eof(); c = text_.get()) {
      if (c == '"') {
        if (text_.peek() != '"') {
          return;
        }
        text_.get();
      }
      line_ += c == '\n' ? 1 : 0;
      add(field, c);
    }
    fail(name_, begin_, "a quote is not closed");
  }

  std::istream& text_;
  const std::string& name_;
  std::size_t line_ = 1;
  std::size_t begin_ = 1;
};

}  // namespace

Csv Csv::read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    fail(path, 0, "cannot be read");
  }
  return parse(file, path);
}

Csv Csv::parse(std::istream& text, const std::string& name) {
  Csv out;
  out.name_ = name;
  Records records(text, name);
  if (!records.next(out.header_)) {
    fail(name, 1, "there is no header");
  }
  out.width_ = out.header_.size();
  std::vector<std::string> fields;
  while (records.next(fields)) {
    if (fields.size() != out.width_) {
      fail(name, records.line(),
           "the row has " + std::to_string(fields.size()) + " fields, the header " +
               std::to_string(out.width_));
    }
    if (out.cells_.size() + out.width_ > kCellLimit) {
      fail(name, records.line(), "the table is too large");
    }
    std::move(fields.begin(), fields.end(), std::back_inserter(out.cells_));
    out.lines_.push_back(records.line());
  }
  return out;
}

bool Csv::has(std::string_view column) const noexcept {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

std::size_t Csv::column(std::string_view name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) {
    fail(name_, 1, "there is no column \"" + std::string(name) + "\"");
  }
  return static_cast<std::size_t>(found - header_.begin());
}

double Csv::number(std::size_t row, std::size_t column) const {
  const std::string& cell = text(row, column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
    fail(name_, lines_[row], "\"" + cell + "\" in column \"" + header_[column] + "\" is no number");
  }
  return value;
}

}  // namespace haptic::plot
