#pragma once
// A Falcon as its host sees it through the bridge: boot loader, firmware upload, homing, packets, a grip that
// a test holds somewhere and motors whose force it feels. Written from the description of the protocol, not
// with the driver's code: it is the other end of every test of the driver. No clock, no I/O.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace haptic::test {

class FalconEmulator {
 public:
  enum class Stage { kBootLoader, kLoadMode, kRunning };

  /// What goes wrong.
  struct Troubles {
    int deaf_hellos = 0;        // so many handshakes are not answered
    int changed_echoes = 0;     // so many uploads have one echo changed
    bool leading_zero = false;  // a zero byte before the answer to the handshake
    bool silent = false;        // answers no packet
    std::size_t garbage = 0;    // bytes before each reply
    bool keeps_marks = false;   // a packet that asks for no homing does not make it forget them
  };

  /// Only these bytes make it run; empty: it runs already.
  explicit FalconEmulator(std::vector<std::uint8_t> firmware = {});

  // ---- the bridge's side ----

  /// A vendor request of the host.
  void control(std::uint8_t request, std::uint16_t value);
  /// Bytes from the host.
  void receive(std::span<const std::uint8_t> bytes);
  /// At most `most` bytes to the host.
  std::vector<std::uint8_t> send(std::size_t most);

  // ---- the user's side ----

  /// Holds the grip at `position` (m, the device's frame), as exactly as the encoders tell. Aborts outside
  /// the workspace.
  void hold_at(const glm::dvec3& position);
  /// Turns the encoders to these counts.
  void turn_to(const std::array<int, 3>& counts) { counts_ = counts; }
  /// Which encoders have passed their marks: bit n is encoder n + 1.
  void set_homed(unsigned bits) { homed_ = bits; }
  void press(unsigned buttons) { buttons_ = buttons; }

  /// What the motors do to the hand at the place where the encoders say it is: N, the device's frame, with
  /// 10000 words for 1 N m, by the principle of virtual work with central differences of the geometry.
  glm::dvec3 force() const;

  // ---- what it has seen ----

  Stage stage() const { return stage_; }
  const std::array<int, 3>& motors() const { return motors_; }
  unsigned homed() const { return homed_; }
  unsigned flags() const { return flags_; }  // bit 0 homing, 1 green, 2 blue, 3 red
  std::size_t packets() const { return packets_; }
  std::size_t broken_bytes() const { return broken_; }  // that belong to no packet

  Troubles troubles;

 private:
  void take_boot_byte(std::uint8_t byte);
  void take_load_byte(std::uint8_t byte);
  void take_packet_byte(std::uint8_t byte);
  void obey();
  void answer();

  std::vector<std::uint8_t> firmware_;
  Stage stage_;
  std::uint16_t baud_ = 0;
  bool dtr_ = false;
  bool was_reset_ = false;  // DTR went up
  std::size_t hello_ = 0;
  std::vector<std::uint8_t> loaded_;
  std::vector<std::uint8_t> packet_;
  std::deque<std::uint8_t> out_;

  std::array<int, 3> counts_{};
  std::array<int, 3> motors_{};
  unsigned homed_ = 0;
  unsigned buttons_ = 0;
  unsigned flags_ = 0;
  std::size_t packets_ = 0;
  std::size_t broken_ = 0;
};

}  // namespace haptic::test
