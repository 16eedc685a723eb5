#pragma once
// The PCI card of a PHANToM through the kernel's driver "phantom" (linux/phantom.h): eight input and eight
// output registers, and an interrupt. It knows neither what the registers mean nor what is safe to write.
//
// Two ways to write outputs. As opened, a write goes to the card at once. After hold_outputs(), the kernel
// keeps what was written last and writes it again in each interrupt, beside which it toggles the amplifiers'
// sign of life: for as long as the card runs, whatever has become of this process's threads. It keeps it over
// close() and open(), too, so that outputs must be written before each start().
//
// Functions throw DeviceError; none waits for ever. read(), write() and stop() may be called by two threads
// at once, as the kernel locks the registers. Not real-time safe.

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

namespace haptic::drivers::io {

/// One bit for each register.
using RegisterMask = std::uint32_t;
using Registers = std::array<std::uint32_t, 8>;

class PhantomCard {
 public:
  /// Opens it for itself alone.
  explicit PhantomCard(const std::string& path);
  ~PhantomCard();

  PhantomCard(const PhantomCard&) = delete;
  PhantomCard& operator=(const PhantomCard&) = delete;

  /// From now until it is closed, outputs are held and written in each interrupt. Before start().
  void hold_outputs();

  /// Lets interrupts come.
  void start();
  /// Ends them. Without hold_outputs() it also takes the amplifiers' bit back.
  void stop();

  /// Whether an interrupt has come since the last read(), waiting for one up to `timeout`. Throws if the card
  /// does not run.
  bool wait(std::chrono::milliseconds timeout);

  /// The input registers of `mask`; 0 for the others, which are not touched.
  Registers read(RegisterMask mask);

  /// The output registers of `mask`.
  void write(RegisterMask mask, const Registers& values);

 private:
  std::string path_;
  int file_ = -1;
};

}  // namespace haptic::drivers::io
