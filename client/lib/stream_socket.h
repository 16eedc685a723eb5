#pragma once
// A connected stream socket with deadlines: plain POSIX calls, closed on destruction.

#include <chrono>
#include <span>
#include <string_view>

#include "client/lib/address.h"

namespace haptic::client {

using Clock = std::chrono::steady_clock;

class StreamSocket {
 public:
  /// Throws Unreachable, in words that tell what to do.
  static StreamSocket connect(const Address& address, Clock::time_point deadline);

  explicit StreamSocket(int descriptor) noexcept : descriptor_(descriptor) {}
  StreamSocket(StreamSocket&& other) noexcept;
  StreamSocket& operator=(StreamSocket&& other) noexcept;
  StreamSocket(const StreamSocket&) = delete;
  StreamSocket& operator=(const StreamSocket&) = delete;
  ~StreamSocket();

  enum class Outcome { kDone, kTimedOut, kInterrupted, kClosed };

  /// Sends all of it.
  Outcome send(std::string_view bytes, Clock::time_point deadline) noexcept;

  /// Receives at least one byte; `received` of the buffer are filled. A signal interrupts it.
  Outcome receive(std::span<char> buffer, std::size_t& received, Clock::time_point deadline) noexcept;

  int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_ = -1;
};

}  // namespace haptic::client
