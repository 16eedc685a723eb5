#include "ipc/handlers.h"

namespace haptic::ipc {

void handle_get_scene(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  desk.scenes.describe(request.get_scene(), caller.answer_bytes, reply);
}

void handle_load_scene(Desk& desk, const Caller& /*caller*/, const v1::Request& request, const Reply& reply) {
  desk.scenes.load(request.load_scene(), reply);
}

void handle_edit_scene(Desk& desk, const Caller& /*caller*/, const v1::Request& request, const Reply& reply) {
  desk.scenes.edit(request.edit_scene(), reply);
}

}  // namespace haptic::ipc
