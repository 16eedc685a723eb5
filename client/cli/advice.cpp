#include "client/cli/advice.h"

namespace haptic::cli {

std::string advise(v1::FaultKind kind) {
  switch (kind) {
    case v1::FAULT_NOT_FINITE:
      return "look at the device's driver and at the scene around that tick: a position or a force was no "
             "number";
    case v1::FAULT_OVER_SPEED:
      return "see that nothing pushes the hand away: lower stiffness or forces; raise safety.max_speed only "
             "if the hand "
             "itself was that fast";
    case v1::FAULT_STALE_SAMPLE:
      return "look at the device's cable and power, and at hapticctl devices: its samples did not come in "
             "time";
    case v1::FAULT_MISSED_TICKS:
      return "see that the servo thread has real-time priority (hapticctl status), and what else the machine "
             "does";
    case v1::FAULT_LOST_DRIVER:
      return "see why the program that held the drive lease ended or was silent, then start it again";
    case v1::FAULT_OVER_TRAVEL:
      return "move the device back to where it may be (limits.travel of the config)";
    case v1::FAULT_ENERGY:
      return "the contact was not stable: lower the stiffness of the finger, or add viscosity";
    case v1::FAULT_LOST_DEVICE:
      return "plug the device in again, and wait until hapticctl devices calls it ready";
    case v1::FAULT_EMERGENCY_STOP:
      return "a person stopped it: ask why before you go on";
    case v1::FAULT_STILL_SAMPLE:
      return "see whether the device still measures: its position did not change at all; restart it";
    default:
      return "this program does not know the fault: install one as new as the daemon";
  }
}

}  // namespace haptic::cli
