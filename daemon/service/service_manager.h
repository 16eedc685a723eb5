#pragma once
// What passes between the daemon and the service manager that started it, systemd: the sockets that it opened
// beforehand, and what it is told about the daemon's state. Without one all of this does nothing, and
// whatever it does with what it is told, the daemon goes on. No function here is for the servo thread.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haptic::service {

/// Listening sockets that the service manager passed; the caller owns them. Once, before there are threads:
/// the environment variables that tell of them are removed.
std::vector<int> take_passed_sockets();

/// The daemon serves, and devices are in its hands; also after a reload.
void tell_ready(const std::string& status) noexcept;

void tell_status(const std::string& status) noexcept;

/// The config is read again; tell_ready() ends it.
void tell_reloading() noexcept;

void tell_stopping() noexcept;

/// How long the service manager waits for feed_watchdog() before it kills the daemon, in ns; nothing: it does
/// not watch.
std::optional<std::int64_t> watchdog_limit_ns() noexcept;

/// The daemon is alive: to be said by what judges its health (heartbeat_watch.h).
void feed_watchdog() noexcept;

}  // namespace haptic::service
