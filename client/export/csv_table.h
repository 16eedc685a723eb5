#pragma once
// A table as a CSV file.

#include "client/export/tables.h"
#include "proto/csv/csv_file.h"

namespace haptic::exporting {

class CsvTable : public TableWriter {
 public:
  CsvTable(const std::string& path, std::span<const Column> columns);

  void add(std::uint64_t count) override { file_.add(count); }
  void add(double number) override { file_.add(number); }
  void add(bool flag) override { file_.add(flag); }
  void add(std::string_view text) override { file_.add(text); }
  void end_row() override { file_.end_row(); }
  void close() override { file_.close(); }

 private:
  csv::CsvFile file_;
};

}  // namespace haptic::exporting
