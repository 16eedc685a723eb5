#pragma once
// Lines for a person. What anybody on the network can cause is told once a second at the most.

#include <chrono>
#include <functional>
#include <string>
#include <utility>

namespace haptic::gateway {

class Log {
 public:
  explicit Log(std::function<void(const std::string&)> write) : write_(std::move(write)) {}

  void tell(const std::string& line) const { write_(line); }

  void tell_seldom(const std::string& line) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= next_) {
      next_ = now + std::chrono::seconds(1);
      write_(line);
    }
  }

 private:
  std::function<void(const std::string&)> write_;
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace haptic::gateway
