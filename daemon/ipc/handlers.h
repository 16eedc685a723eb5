#pragma once
// One function for each call; a family has a file. All run on the io thread and never wait. The role has been
// checked before they are called.

#include "ipc/dispatch.h"

namespace haptic::ipc {

using Handler = void (*)(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);

// handle_status.cpp
void handle_get_status(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_devices.cpp
void handle_list_devices(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_manage_device(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_scene.cpp
void handle_get_scene(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_load_scene(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_edit_scene(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_state.cpp
void handle_get_state(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_servo.cpp: what the servo thread does itself
void handle_servo_command(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_emergency_stop(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_arm(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_drive.cpp
void handle_acquire_drive(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_release_drive(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_heartbeat(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_move.cpp
void handle_move_device(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_faults.cpp
void handle_list_faults(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_stats.cpp
void handle_get_stats(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
// handle_subscribe.cpp
void handle_subscribe(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);
void handle_unsubscribe(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);

}  // namespace haptic::ipc
