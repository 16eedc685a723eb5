#pragma once
// Keeps all cores out of deep sleep: while /dev/cpu_dma_latency is held open with 0 in it, no core goes to a
// state that takes time to wake from. That costs power, so it is held only while it matters. Where the node
// cannot be opened nothing is lost but time, and a sentence tells so once.
//
// One thread at a time. Not real-time safe.

#include <string>

namespace haptic::rt {

inline constexpr const char* kCpuLatencyNode = "/dev/cpu_dma_latency";

class CpuLatency {
 public:
  explicit CpuLatency(std::string node = kCpuLatencyNode);
  /// Releases it.
  ~CpuLatency();

  CpuLatency(const CpuLatency&) = delete;
  CpuLatency& operator=(const CpuLatency&) = delete;

  /// Holds it; nothing if it is held. Returns a sentence for a person the first time that the system refuses,
  /// else nothing.
  std::string hold();
  void release() noexcept;
  bool is_held() const noexcept { return file_ >= 0; }

 private:
  std::string node_;
  int file_ = -1;
  bool has_warned_ = false;
};

}  // namespace haptic::rt
