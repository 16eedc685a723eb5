#pragma once
// One client at a time may drive. The holder of the lease proves by heartbeats that it is alive; when it is
// not, or its connection ends, the servo thread is told what the config says: to let forces go down and latch
// a fault, to disarm, or nothing. io thread.

#include <chrono>
#include <optional>
#include <string>

#include "haptic/v1/config.pb.h"
#include "ipc/publisher.h"
#include "ipc/servo_link.h"

namespace haptic::ipc {

struct DrivePolicy {
  v1::Drive::OnLoss on_loss = v1::Drive::FAULT;
  std::chrono::milliseconds longest_silence{100};
};

/// Who a client is, for others to read.
struct Driver {
  std::string name;     // that the daemon knows it by
  std::string program;  // that it calls itself
};

class DriveLease {
 public:
  struct Holder {
    ClientId client;
    Driver driver;
    std::chrono::milliseconds silence;  // the longest, as agreed
    SteadyClock::time_point last_sign;
    bool was_late = false;  // in the poll before
  };

  DriveLease(const DrivePolicy& policy, ServoLink& servo) : policy_(policy), servo_(servo) {}

  /// From now on; a holder keeps the silence that was agreed.
  void set_policy(const DrivePolicy& policy) noexcept { policy_ = policy; }

  std::chrono::milliseconds longest_silence() const noexcept { return policy_.longest_silence; }

  const std::optional<Holder>& holder() const noexcept { return holder_; }

  /// Why this client may not arm or take the lease now: who holds it. Nothing if it may.
  std::optional<std::string> refusal(ClientId client) const;

  /// Only without refusal(). The holder itself may take it again, to agree on another silence.
  void acquire(ClientId client, Driver driver, std::chrono::milliseconds silence,
               SteadyClock::time_point now);
  /// False if the client does not hold it; so for the next.
  bool release(ClientId client);
  bool beat(ClientId client, SteadyClock::time_point now);

  /// The client's connection ends.
  void forget(ClientId client, SteadyClock::time_point now);

  /// Finds a holder that is silent. To be called every few milliseconds.
  void poll(SteadyClock::time_point now);

 private:
  void lose(const safety::Fault& fault, const std::string& how, SteadyClock::time_point now);
  void tell_servo(SteadyClock::time_point now);

  DrivePolicy policy_;
  ServoLink& servo_;
  std::optional<Holder> holder_;
  std::optional<servo::Command> untold_;  // of a loss, until the servo thread's queue has room
};

}  // namespace haptic::ipc
