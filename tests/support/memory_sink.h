#pragma once
// A sink in memory that can fail as a full disk does.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "proto/recording/error.h"
#include "proto/recording/sink.h"

namespace haptic::test {

class MemorySink : public recording::Sink {
 public:
  /// Room for so many bytes; what fits of a write is written before it fails.
  std::uint64_t room = std::numeric_limits<std::uint64_t>::max();
  bool can_truncate = true;

  std::string bytes;
  int syncs = 0;

  void write(std::string_view more) override {
    const std::uint64_t left = room - bytes.size();
    bytes += more.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(left, more.size())));
    if (more.size() > left) {
      throw recording::IoError("disk: cannot be written: No space left on device");
    }
  }
  void truncate(std::uint64_t size) override {
    if (!can_truncate) {
      throw recording::IoError("disk: cannot be shortened");
    }
    bytes.resize(static_cast<std::size_t>(size));
  }
  void sync() override { ++syncs; }
};

}  // namespace haptic::test
