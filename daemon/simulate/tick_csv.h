#pragma once
// What `hapticd simulate` writes of each tick. World frame, SI units.

#include <optional>
#include <span>
#include <string>

#include "engine/world.h"
#include "proto/csv/csv_file.h"
#include "servo/mailbox.h"

namespace haptic::simulate {

/// Which files to write; an empty path: none.
struct CsvPaths {
  std::string hips;     // each HIP in each object that holds it; forces before the guard
  std::string objects;  // poses, velocities and what HIPs apply
  std::string devices;  // poses, and the forces that the guard let through
};

class TickCsv {
 public:
  /// Throws csv::OutputError, as everything here.
  explicit TickCsv(const CsvPaths& paths);

  /// The rows of one tick at `time` (s). `snapshot` is that of the tick; `devices` are the names.
  void write(double time, const engine::World& world, const servo::Snapshot& snapshot,
             std::span<const std::string> devices);

  void close();

 private:
  void write_hips(double time, const engine::World& world, std::uint64_t tick);
  void write_objects(double time, const engine::Scene& scene, const servo::Snapshot& snapshot);
  void write_devices(double time, const servo::Snapshot& snapshot, std::span<const std::string> devices);

  std::optional<csv::CsvFile> hips_;
  std::optional<csv::CsvFile> objects_;
  std::optional<csv::CsvFile> devices_;
};

}  // namespace haptic::simulate
