#pragma once
// A run as a recording, the same that `hapticctl record` makes of the service. Its clock is the virtual one,
// from 0.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "load/scene_file.h"
#include "proto/recording/session.h"
#include "servo/mailbox.h"

namespace haptic::simulate {

class TickRecording {
 public:
  /// Makes or empties the file; `devices` are the names in the order of the device set. Throws
  /// csv::OutputError, as everything here.
  TickRecording(const std::string& path, const load::LoadedScene& scene, double rate_hz,
                std::span<const std::string> devices);

  void write(const servo::Snapshot& snapshot);

  /// The state after the tick of the snapshot: a replay of what follows can start there.
  void write(const engine::State& state, const servo::Snapshot& snapshot);

  /// A fault of the tick at `time_ns`.
  void write(const safety::Fault& fault, std::uint64_t time_ns);

  /// Only when this has returned is the file complete.
  void close();

 private:
  double rate_hz_;
  std::vector<v1::DeviceDescription> devices_;
  std::unique_ptr<recording::FileSink> sink_;
  std::unique_ptr<recording::SessionWriter> writer_;
  std::uint64_t sequence_ = 0;
  v1::Frame frame_;
};

}  // namespace haptic::simulate
