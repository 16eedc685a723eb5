#pragma once
// The serial protocol of a Polhemus FASTRAK, and of trackers that speak like it: commands are ASCII; of each
// station a binary record of 32 bytes comes for as long as it is asked to send, with the output list 2,11,0:
//
//     0   '0'                      4 bytes a number, IEEE 754, little endian
//     1   station '1' to '4'
//     2   ' ', or a letter for an error
//     3   x, y, z                  cm after the command u; place of the receiver in the transmitter's frame
//     15  w, x, y, z               its rotation
//     31  ' '
//
// There is no escape: '0' occurs inside of records too. What counts as one is therefore checked in all that
// is known of it, down to the length of the quaternion. Pure; real-time safe but for start_commands().

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace haptic::drivers::fastrak {

inline constexpr std::size_t kRecordBytes = 32;

struct Record {
  int station = 0;                             // 1 to 4
  char error = ' ';                            // ' ': none
  glm::dvec3 position{0.0};                    // m
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // unit
};

/// Finds records in a stream that may be split anywhere and hold anything.
class RecordParser {
 public:
  /// One more byte. True if it completes a record, which `record` then holds.
  bool take(std::uint8_t byte, Record& record) noexcept;

 private:
  std::array<std::uint8_t, kRecordBytes> bytes_{};
  std::size_t length_ = 0;
};

/// Ends what the tracker sends, and asks for its status.
inline constexpr char kSilence[] = "c";
inline constexpr char kStatus[] = "S";

/// Whether these bytes are a status record, which begins with '2', the station and 'S' and ends with CR LF.
bool is_status(const std::vector<std::uint8_t>& bytes) noexcept;

/// What to send, one after the other, for binary records of `station` in cm, unfiltered, until kSilence. The
/// receiver is in the half of space that `hemisphere` points to: a magnetic field cannot tell.
std::vector<std::string> start_commands(int station, const glm::dvec3& hemisphere);

}  // namespace haptic::drivers::fastrak
