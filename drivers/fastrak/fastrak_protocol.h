#pragma once
// The serial protocols of Polhemus trackers, and of trackers that speak like them. Commands are ASCII; of
// each station a binary record comes for as long as it is asked to send. Numbers are IEEE 754 of 4 bytes,
// little endian. There is no escape: what begins a record occurs inside of records too. What counts as one is
// therefore checked in all that is known of it, down to the length of the quaternion.
//
//     FASTRAK, output list 2,11,0                   LIBERTY and PATRIOT, output list 2,7,0
//     0   '0'                                       0   "LY", "LU" (a Latus); "PA"
//     1   station '1' to '4'                        2   station, from 1, as a number
//     2   ' ', or a letter for an error             3   the command that is answered
//                                                   4   ' ', or a character for an error
//                                                   6   bytes that follow the first 8: 29
//     3   x, y, z: place of the receiver            8   likewise
//         in the transmitter's frame, cm
//     15  w, x, y, z: its rotation                  20  likewise
//     31  ' '                                       36  ' '
//
// Pure; real-time safe but for what makes commands.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace haptic::drivers::fastrak {

enum class Model : std::uint8_t { kFastrak, kLiberty, kPatriot };

/// Its stations are numbered from 1 to this.
constexpr int stations_of(Model model) noexcept {
  if (model == Model::kFastrak) return 4;
  return model == Model::kLiberty ? 16 : 2;
}
inline constexpr int kMostStations = 16;

inline constexpr std::size_t kRecordBytes = 32;         // of a FASTRAK
inline constexpr std::size_t kLibertyRecordBytes = 37;  // of the others

struct Record {
  int station = 0;                             // from 1
  char error = ' ';                            // ' ': none
  glm::dvec3 position{0.0};                    // m
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // unit
};

/// Finds records in a stream that may be split anywhere and hold anything.
class RecordParser {
 public:
  explicit RecordParser(Model model = Model::kFastrak) noexcept : model_(model) {}

  /// One more byte. True if it completes a record, which `record` then holds.
  bool take(std::uint8_t byte, Record& record) noexcept;

 private:
  Model model_;
  std::array<std::uint8_t, kLibertyRecordBytes> bytes_{};
  std::size_t length_ = 0;
};

/// One receiver that shall be told of.
struct Station {
  int number = 1;  // from 1
  /// The receiver is in the half of space that this points to: a magnetic field cannot tell.
  glm::dvec3 hemisphere{1.0, 0.0, 0.0};
};

/// Ends what the tracker sends.
std::string silence_command(Model model);
/// Asks it who it is.
std::string status_command(Model model);

/// Whether these bytes answer status_command(). A FASTRAK's begin with '2', the station and 'S' and end with
/// CR LF; of the others only that they are text that ends so is known.
bool is_status(Model model, const std::vector<std::uint8_t>& bytes) noexcept;

/// What to send, one after the other, for binary records of these stations and no others, in cm, unfiltered,
/// until silence_command().
std::vector<std::string> start_commands(Model model, const std::vector<Station>& stations);

}  // namespace haptic::drivers::fastrak
