#pragma once
// What a line of the log says to machines beside its words, for the journal: journalctl
// HAPTICD_FAULT=over_speed
//
//     const log::Fields fields(log::FieldList{{"HAPTICD_TICK", "12345"}, {"HAPTICD_DEVICE", "left"}});
//     spdlog::warn("...");
//
// Names are capital letters, digits and "_", and begin with a letter. Each thread has its own.

#include <string>
#include <utility>
#include <vector>

namespace haptic::log {

using FieldList = std::vector<std::pair<std::string, std::string>>;

/// The lines of this thread have these fields as long as it lives; within another its come beside those.
class Fields {
 public:
  explicit Fields(FieldList fields);
  ~Fields();
  Fields(const Fields&) = delete;
  Fields& operator=(const Fields&) = delete;

 private:
  std::size_t before_;
};

/// Those of the line that this thread writes now.
const FieldList& current_fields() noexcept;

}  // namespace haptic::log
