#include "drivers/fastrak/fastrak_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace haptic::drivers::fastrak {

namespace {

constexpr double kCentimetre = 0.01;
// m: the trackers reach 3 m, with an extended range a little more
constexpr double kFurthest = 10.0;
constexpr double kShortest = 0.99;
constexpr double kLongest = 1.01;
constexpr std::size_t kLibertyHead = 8;
constexpr std::uint8_t kLibertyBody = kLibertyRecordBytes - kLibertyHead;

float number_at(const std::uint8_t* bytes) noexcept {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
  return std::bit_cast<float>(bits);
}

std::size_t record_bytes(Model model) noexcept {
  return model == Model::kFastrak ? kRecordBytes : kLibertyRecordBytes;
}

bool is_letter(std::uint8_t byte) noexcept {
  return (byte >= 'A' && byte <= 'Z') || (byte >= 'a' && byte <= 'z');
}

bool fastrak_can_begin(const std::uint8_t* bytes, std::size_t length) noexcept {
  if (length > 0 && bytes[0] != '0') return false;
  if (length > 1 && (bytes[1] < '1' || bytes[1] > '4')) return false;
  return length <= 2 || bytes[2] == ' ' || is_letter(bytes[2]);
}

bool liberty_can_begin(Model model, const std::uint8_t* bytes, std::size_t length) noexcept {
  const bool is_patriot = model == Model::kPatriot;
  if (length > 0 && (is_patriot ? bytes[0] != 'P' : bytes[0] != 'L')) return false;
  if (length > 1 && (is_patriot ? bytes[1] != 'A' : bytes[1] != 'Y' && bytes[1] != 'U')) return false;
  if (length > 2 && (bytes[2] < 1 || bytes[2] > stations_of(model))) return false;
  constexpr std::uint8_t kLastPrintable = 0x7E;
  if (length > 4 && (bytes[4] < ' ' || bytes[4] > kLastPrintable)) return false;
  if (length > 6 && bytes[6] != kLibertyBody) return false;
  return length <= 7 || bytes[7] == 0;
}

/// Whether a record can begin with these bytes.
bool can_begin(Model model, const std::uint8_t* bytes, std::size_t length) noexcept {
  return model == Model::kFastrak ? fastrak_can_begin(bytes, length)
                                  : liberty_can_begin(model, bytes, length);
}

/// From the place on: place, rotation, a space.
bool decode(const std::uint8_t* bytes, Record& record) noexcept {
  if (bytes[28] != ' ') return false;
  const glm::dvec3 position(number_at(bytes), number_at(bytes + 4), number_at(bytes + 8));
  const glm::dquat turn(number_at(bytes + 12), number_at(bytes + 16), number_at(bytes + 20),
                        number_at(bytes + 24));
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(position[axis]) * kCentimetre <= kFurthest)) return false;
  }
  const double length = glm::length(turn);
  if (!(length >= kShortest && length <= kLongest)) return false;
  record.position = kCentimetre * position;
  record.orientation = turn / length;
  return true;
}

/// A whole record, whose head has been looked at.
bool decode(Model model, const std::uint8_t* bytes, Record& record) noexcept {
  if (model == Model::kFastrak) {
    record.station = bytes[1] - '0';
    record.error = static_cast<char>(bytes[2]);
    return decode(bytes + 3, record);
  }
  record.station = bytes[2];
  record.error = static_cast<char>(bytes[4]);
  return decode(bytes + kLibertyHead, record);
}

std::vector<std::string> fastrak_commands(const std::vector<Station>& stations) {
  std::vector<std::string> commands;
  for (int number = 1; number <= stations_of(Model::kFastrak); ++number) {
    const auto wanted = std::find_if(stations.begin(), stations.end(),
                                     [number](const Station& one) { return one.number == number; });
    // one that nobody listens to would take its share of the records
    commands.push_back(fmt::format("l{},{}\r", number, wanted == stations.end() ? 0 : 1));
    if (wanted == stations.end()) continue;
    const glm::dvec3& towards = wanted->hemisphere;
    commands.push_back(fmt::format("O{},2,11,0\r", number));
    commands.push_back(fmt::format("H{},{:.3f},{:.3f},{:.3f}\r", number, towards.x, towards.y, towards.z));
  }
  // filters would lag
  commands.insert(commands.end(), {"x0,1,0,0\r", "v0,1,0,0\r", "u", "f", "C"});
  return commands;
}

std::vector<std::string> liberty_commands(const std::vector<Station>& stations) {
  std::vector<std::string> commands = {"F1\r", "U1\r", "O*,2,7,0\r"};
  for (const Station& station : stations) {
    const glm::dvec3& towards = station.hemisphere;
    commands.push_back(
        fmt::format("H{},{:.3f},{:.3f},{:.3f}\r", station.number, towards.x, towards.y, towards.z));
  }
  commands.insert(commands.end(), {"X0,1,0,0\r", "Y0,1,0,0\r", "C\r"});
  return commands;
}

}  // namespace

bool RecordParser::take(std::uint8_t byte, Record& record) noexcept {
  const std::size_t whole = record_bytes(model_);
  bytes_[length_++] = byte;
  if (length_ == whole && can_begin(model_, bytes_.data(), length_)) {
    Record found;
    if (decode(model_, bytes_.data(), found)) {
      record = found;
      length_ = 0;
      return true;
    }
  }
  // drop bytes from the front until what is left may be the beginning of a record
  std::size_t dropped = length_ == whole ? 1 : 0;
  while (dropped < length_ && !can_begin(model_, bytes_.data() + dropped, length_ - dropped)) ++dropped;
  if (dropped > 0) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(dropped),
              bytes_.begin() + static_cast<std::ptrdiff_t>(length_), bytes_.begin());
    length_ -= dropped;
  }
  return false;
}

std::string silence_command(Model model) { return model == Model::kFastrak ? "c" : "P\r"; }

std::string status_command(Model model) { return model == Model::kFastrak ? "S" : "\x16\r"; }

bool is_status(Model model, const std::vector<std::uint8_t>& bytes) noexcept {
  const std::size_t shortest = model == Model::kFastrak ? 54 : 8;
  if (bytes.size() < shortest || bytes[bytes.size() - 2] != '\r' || bytes.back() != '\n') return false;
  return model != Model::kFastrak || (bytes[0] == '2' && bytes[2] == 'S');
}

std::vector<std::string> start_commands(Model model, const std::vector<Station>& stations) {
  return model == Model::kFastrak ? fastrak_commands(stations) : liberty_commands(stations);
}

}  // namespace haptic::drivers::fastrak
