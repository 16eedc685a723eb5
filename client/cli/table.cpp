#include "client/cli/table.h"

#include <algorithm>
#include <utility>

namespace haptic::cli {
namespace {

void append_line(const std::vector<Column>& columns, const std::vector<std::size_t>& widths,
                 const std::vector<std::string>& cells, std::string& out) {
  const std::size_t start = out.size();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string padding(widths[i] - width(cells[i]), ' ');
    out += i == 0 ? "" : "  ";
    out += columns[i].align == Align::kLeft ? cells[i] + padding : padding + cells[i];
  }
  out.erase(std::max(out.find_last_not_of(' ') + 1, start));
  out += '\n';
}

}  // namespace

std::size_t width(const std::string& text) noexcept {
  // continuation bytes of UTF-8 are 10xxxxxx
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

void Table::add(std::vector<std::string> row) {
  row.resize(columns_.size());
  rows_.push_back(std::move(row));
}

std::string Table::to_string() const {
  std::vector<std::string> headings;
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    headings.push_back(columns_[i].heading);
    widths.push_back(width(columns_[i].heading));
    for (const auto& row : rows_) {
      widths[i] = std::max(widths[i], width(row[i]));
    }
  }
  std::string out;
  append_line(columns_, widths, headings, out);
  for (const auto& row : rows_) {
    append_line(columns_, widths, row, out);
  }
  return out;
}

}  // namespace haptic::cli
