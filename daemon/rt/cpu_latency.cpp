#include "rt/cpu_latency.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

namespace haptic::rt {

CpuLatency::CpuLatency(std::string node) : node_(std::move(node)) {}

CpuLatency::~CpuLatency() { release(); }

std::string CpuLatency::hold() {
  if (is_held()) return {};
  file_ = ::open(node_.c_str(), O_WRONLY | O_CLOEXEC);
  const std::int32_t microseconds = 0;
  const bool is_written =
      is_held() && ::write(file_, &microseconds, sizeof microseconds) == sizeof microseconds;
  if (is_written) return {};
  const int error = errno;
  release();
  if (has_warned_) return {};
  has_warned_ = true;
  return node_ + ": " + std::generic_category().message(error) +
         "; cores may sleep deeply while devices push, and ticks be late by the time that they take to wake. "
         "Install config/udev/70-hapticd.rules to permit it";
}

void CpuLatency::release() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

}  // namespace haptic::rt
