#pragma once
// Whether a node can be opened, and by whom it is held.

#include <string>

#include "client/doctor/finding.h"
#include "client/doctor/machine.h"

namespace haptic::doctor {

/// The rules that let members of plugdev use devices, installed.
inline constexpr const char* kInstallRules =
    "sudo cp config/udev/70-hapticd.rules /etc/udev/rules.d/ && sudo udevadm control --reload && sudo "
    "udevadm trigger";

/// Adds what is wrong with opening `node` for reading and writing; true if nothing is. Of who holds it the
/// daemon is no stranger.
bool check_node(const Machine& machine, const std::string& about, const std::string& node,
                Findings& findings);

/// The same for a serial port, with its latency timer and who may talk to it unasked.
bool check_serial(const Machine& machine, const std::string& about, const std::string& port,
                  Findings& findings);

}  // namespace haptic::doctor
