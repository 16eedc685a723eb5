#pragma once
// A SensAble PHANToM on its PCI card. Each interrupt of the card is one round: registers in, sample to the
// servo, the live force out. What the calibration does not tell, nothing guesses:
//
//     no calibration         the card is opened, and no register touched: no position, no force
//     max_force 0            positions; outputs and amplifiers are not touched
//     max_force above 0      positions and force
//
// The kernel writes what it holds in each interrupt for as long as the card runs, so expiry alone does not
// end a force whose thread hangs: a second thread watches it, and lets the kernel hold no torque if a round
// lasts longer than `patience`. On every way out no torque is held for one interrupt more; then the card is
// stopped and opened anew, when outputs reach it at once, and it gets no torque again. If the process is
// killed the kernel closes the card: its interrupts end, and with them the amplifiers' sign of life; that
// they then let go is not known.

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "drivers/device_link.h"
#include "drivers/phantom/phantom_control.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::phantom {

struct PhantomSettings {
  std::string name;
  std::string path;                          // e.g. "/dev/phantom0"
  std::optional<Calibration> calibration{};  // none: neither position nor force
  double max_force = 0.0;                    // N; 0: positions only
  BasePose world_from_base{};
  std::chrono::milliseconds patience{20};  // that a round may last
  std::chrono::milliseconds silence{50};   // without an interrupt, after which the card is given up
};

std::unique_ptr<Device> make_phantom(PhantomSettings settings);

}  // namespace haptic::drivers::phantom
