#include "ipc/dispatch.h"

#include <algorithm>
#include <array>

#include "ipc/handlers.h"

namespace haptic::ipc {
namespace {

struct Row {
  v1::Request::CallCase call;
  v1::Role least;
  Handler handle;
};

// Disarming needs less than arming: whoever may change a scene may also end all force. Clearing a fault is
// for the person who answers for the device.
constexpr std::array kRows = {
    Row{v1::Request::kGetStatus, v1::OBSERVE, handle_get_status},
    Row{v1::Request::kListDevices, v1::OBSERVE, handle_list_devices},
    Row{v1::Request::kGetScene, v1::OBSERVE, handle_get_scene},
    Row{v1::Request::kGetStats, v1::OBSERVE, handle_get_stats},
    Row{v1::Request::kGetState, v1::OBSERVE, handle_get_state},
    Row{v1::Request::kListFaults, v1::OBSERVE, handle_list_faults},
    Row{v1::Request::kSubscribe, v1::OBSERVE, handle_subscribe},
    Row{v1::Request::kUnsubscribe, v1::OBSERVE, handle_unsubscribe},
    Row{v1::Request::kLoadScene, v1::SCRIPT, handle_load_scene},
    Row{v1::Request::kEditScene, v1::SCRIPT, handle_edit_scene},
    Row{v1::Request::kResetScene, v1::SCRIPT, handle_servo_command},
    Row{v1::Request::kPause, v1::SCRIPT, handle_servo_command},
    Row{v1::Request::kResume, v1::SCRIPT, handle_servo_command},
    Row{v1::Request::kStep, v1::SCRIPT, handle_servo_command},
    Row{v1::Request::kDisarm, v1::SCRIPT, handle_servo_command},
    Row{v1::Request::kEmergencyStop, v1::SCRIPT, handle_emergency_stop},
    Row{v1::Request::kArm, v1::DRIVE, handle_arm},
    Row{v1::Request::kAcquireDrive, v1::DRIVE, handle_acquire_drive},
    Row{v1::Request::kReleaseDrive, v1::DRIVE, handle_release_drive},
    Row{v1::Request::kHeartbeat, v1::DRIVE, handle_heartbeat},
    Row{v1::Request::kMoveDevice, v1::DRIVE, handle_move_device},
    Row{v1::Request::kManageDevice, v1::DRIVE, handle_manage_device},
    Row{v1::Request::kClearFault, v1::ADMIN, handle_servo_command},
};

const Row* find_row(v1::Request::CallCase call) noexcept {
  const auto* const row =
      std::find_if(kRows.begin(), kRows.end(), [call](const Row& entry) { return entry.call == call; });
  return row == kRows.end() ? nullptr : row;
}

}  // namespace

v1::Role least_role(const v1::Request& request) noexcept {
  // counters belong to everybody who reads them
  if (request.has_get_stats() && request.get_stats().reset()) {
    return v1::SCRIPT;
  }
  const Row* const row = find_row(request.call_case());
  return row == nullptr ? v1::ROLE_UNSPECIFIED : row->least;
}

void dispatch(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  const Row* const row = find_row(request.call_case());
  if (row == nullptr) {
    reply.fail(v1::Error::UNSUPPORTED, "hapticd " + desk.services.version + " does not know this call");
    return;
  }
  const v1::Role least = least_role(request);
  if (caller.role < least) {
    reply.fail(v1::Error::REFUSED,
               "this needs the role " + v1::Role_Name(least) + "; yours is " + v1::Role_Name(caller.role));
    return;
  }
  row->handle(desk, caller, request, reply);
}

}  // namespace haptic::ipc
