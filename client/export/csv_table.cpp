#include "client/export/csv_table.h"

namespace haptic::exporting {
namespace {

std::string header_of(std::span<const Column> columns) {
  std::string header;
  for (const Column& column : columns) {
    header += header.empty() ? "" : ",";
    header += column.header;
  }
  return header;
}

}  // namespace

CsvTable::CsvTable(const std::string& path, std::span<const Column> columns)
    : file_(path, header_of(columns)) {}

}  // namespace haptic::exporting
