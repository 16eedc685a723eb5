#include "ipc/convert.h"
#include "ipc/handlers.h"
#include "ipc/reports.h"

namespace haptic::ipc {

v1::Stats report_stats(const Desk& desk) {
  servo::Mailbox& mailbox = desk.services.mailbox;
  mailbox.stats.update();
  return to_wire(mailbox.stats.latest(), desk.services.rate_hz, mailbox.snapshots.lost());
}

void handle_get_stats(Desk& desk, const Caller& /*caller*/, const v1::Request& request, const Reply& reply) {
  v1::Response response;
  *response.mutable_stats() = report_stats(desk);
  if (!request.get_stats().reset()) {
    reply.send(std::move(response));
    return;
  }
  servo::Command command;
  command.kind = servo::CommandKind::kResetStats;
  const bool sent = desk.servo.submit(command, SteadyClock::now(), [reply, response](Outcome outcome) {
    if (outcome == Outcome::kDone) {
      reply.send(response);
    } else {
      reply.fail(v1::Error::FAILED, "the servo thread does not answer; its counters go on");
    }
  });
  if (!sent) {
    reply.fail(v1::Error::BUSY, "the servo thread has too many commands waiting; try again");
  }
}

}  // namespace haptic::ipc
