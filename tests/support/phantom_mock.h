#pragma once
// The card of a PHANToM behind an emulated /dev/phantom0, and what the kernel's driver does with it, as its
// source tells: outputs that are held, written again in each interrupt and kept over closing; the amplifiers'
// bit that each interrupt toggles then; the control register.

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "tests/support/mock_bus.h"

namespace haptic::test {

/// What is seen of the card from outside.
struct PhantomState {
  std::array<std::uint32_t, 8> outputs{};  // as they are at the motors
  std::uint32_t control = 0;
  bool is_running = false;
  bool is_open = false;
  std::uint64_t ioctls = 0;
  std::uint64_t writes = 0;                            // of outputs by the program
  std::uint64_t amp_toggles = 0;                       // of the amplifiers' sign of life
  std::uint32_t read_mask = 0;                         // input registers that were ever read
  std::vector<std::array<std::uint32_t, 3>> motors{};  // outputs 0 to 2, whenever they changed
};

class PhantomMock {
 public:
  /// Plugs it in. An interrupt comes every 2 ms while it runs.
  explicit PhantomMock(MockBus& bus);
  ~PhantomMock();
  PhantomMock(const PhantomMock&) = delete;
  PhantomMock& operator=(const PhantomMock&) = delete;

  PhantomState state() const;
  void set_input(std::size_t index, std::uint32_t value);
  /// What the kernel holds from a program before, which it writes as soon as outputs are held again.
  void leave_behind(const std::array<std::uint32_t, 8>& outputs);
  void set_interrupts(bool come);
  /// The next ioctl takes so long.
  void delay_next(std::chrono::milliseconds delay);
  /// From now on the card is gone.
  void unplug();

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::test
