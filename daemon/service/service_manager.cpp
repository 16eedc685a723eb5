#include "service/service_manager.h"

#include <systemd/sd-daemon.h>

#include <algorithm>

namespace haptic::service {
namespace {

void tell(const std::string& state) noexcept { sd_notify(0, state.c_str()); }

// a line break would begin another assignment
std::string in_one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  return text;
}

}  // namespace

std::vector<int> take_passed_sockets() {
  std::vector<int> sockets;
  const int count = sd_listen_fds(1);
  sockets.reserve(static_cast<std::size_t>(std::max(0, count)));
  for (int i = 0; i < count; ++i) sockets.push_back(SD_LISTEN_FDS_START + i);
  return sockets;
}

void tell_ready(const std::string& status) noexcept { tell("READY=1\nSTATUS=" + in_one_line(status)); }

void tell_status(const std::string& status) noexcept { tell("STATUS=" + in_one_line(status)); }

void tell_reloading() noexcept { tell("RELOADING=1\nSTATUS=reading the config again"); }

void tell_stopping() noexcept { tell("STOPPING=1\nSTATUS=forces go down"); }

std::optional<std::int64_t> watchdog_limit_ns() noexcept {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) <= 0) return std::nullopt;
  return static_cast<std::int64_t>(microseconds) * 1000;
}

void feed_watchdog() noexcept { tell("WATCHDOG=1"); }

}  // namespace haptic::service
