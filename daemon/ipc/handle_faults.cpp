#include "ipc/handlers.h"

namespace haptic::ipc {

void handle_list_faults(Desk& desk, const Caller& /*caller*/, const v1::Request& /*request*/,
                        const Reply& reply) {
  v1::Response response;
  *response.mutable_faults() = desk.faults.list();
  reply.send(std::move(response));
}

}  // namespace haptic::ipc
