#include "service/supervisor.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "service/service_manager.h"

namespace haptic::service {

Supervisor::Supervisor(double rate_hz, std::string status)
    : status_(std::move(status)), watch_(rate_hz, watchdog_limit_ns()) {
  tell_status("waiting until the servo thread keeps its period");
}

void Supervisor::look(std::int64_t now_ns, std::uint64_t heartbeat) {
  switch (watch_.look(now_ns, heartbeat)) {
    case HeartbeatWatch::Verdict::kNothing:
      return;
    case HeartbeatWatch::Verdict::kReady:
      spdlog::info("ready: the servo thread runs {:.0f} ticks a second", watch_.measured_hz());
      ready_ = true;
      tell_ready(status_);
      return;
    case HeartbeatWatch::Verdict::kAlive:
      feed_watchdog();
      return;
  }
}

void Supervisor::reload(const std::function<void()>& read_again) {
  if (!ready_) {
    read_again();
    return;
  }
  tell_reloading();
  read_again();
  tell_ready(status_);
}

}  // namespace haptic::service
