#include "ipc/server_settings.h"

#include <cmath>

#include "flight/fault_files.h"

namespace haptic::ipc {
namespace {

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(seconds * 1e3)));
}

}  // namespace

ServerSettings server_settings(const v1::DaemonConfig& config) {
  const v1::Limits& limits = config.limits();
  ServerSettings settings;
  settings.listen.assign(config.listen().begin(), config.listen().end());
  settings.clients = limits.clients();
  settings.clients_per_user = limits.clients_per_user();
  settings.session.hello = milliseconds(limits.hello());
  settings.session.greeting_bytes = limits.greeting_bytes();
  settings.session.request_bytes = limits.request_bytes();
  settings.session.open_requests = limits.open_requests();
  settings.session.requests_per_second = limits.requests_per_second();
  settings.session.subscriptions = limits.subscriptions();
  settings.session.items = limits.items();
  settings.session.outbox.data_bytes = limits.pending_data();
  settings.session.outbox.control_bytes = limits.pending_control();
  settings.drive.on_loss = config.drive().on_loss();
  settings.drive.longest_silence = milliseconds(config.drive().heartbeat());
  settings.flight.directory = flight::directory_of(config.flight_recorder());
  settings.flight.seconds = config.flight_recorder().seconds();
  settings.flight.keep = config.flight_recorder().keep();
  if (config.metrics().port() != 0) settings.metrics.emplace().port = config.metrics().port();
  return settings;
}

}  // namespace haptic::ipc
