#include "drivers/polhem/polhem_protocol.h"

namespace haptic::drivers::polhem {

namespace {

constexpr std::size_t kInfo = 6;
constexpr std::size_t kCommand = 3;
constexpr std::size_t kAttributes = 4;
constexpr std::int16_t kPreset = 1;
constexpr std::array<std::uint8_t, 3> kDatagramStart = {0xA4, 0x17, 0x42};

std::int16_t word_at(std::span<const std::uint8_t> bytes, std::size_t word) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[2 * word] | bytes[2 * word + 1] << 8U));
}

void put(Message& message, std::size_t word, std::int16_t value) noexcept {
  const auto bits = static_cast<std::uint16_t>(value);
  message[2 * word] = static_cast<std::uint8_t>(bits & 0xFFU);
  message[2 * word + 1] = static_cast<std::uint8_t>(bits >> 8U);
}

}  // namespace

std::optional<Reading> decode_report(std::span<const std::uint8_t> report) noexcept {
  if (report.size() < kMessageBytes) return std::nullopt;
  return Reading{.counts = {word_at(report, 0), word_at(report, 1), word_at(report, 2)},
                 .calibrate = word_at(report, kInfo) == 1};
}

std::optional<Reading> decode_datagram(std::span<const std::uint8_t> datagram) noexcept {
  if (datagram.size() != kDatagramBytes) return std::nullopt;
  for (std::size_t i = 0; i < kDatagramStart.size(); ++i) {
    if (datagram[i] != kDatagramStart[i]) return std::nullopt;
  }
  const std::span<const std::uint8_t> counts = datagram.subspan(kDatagramStart.size());
  return Reading{.counts = {word_at(counts, 0), word_at(counts, 1), word_at(counts, 2)}};
}

Message currents_message(const Joints& milliamperes) noexcept {
  Message message{};
  for (std::size_t joint = 0; joint < 3; ++joint) put(message, joint, milliamperes[joint]);
  return message;
}

Message preset_message(const Joints& counts) noexcept {
  Message message{};
  put(message, kCommand, kPreset);
  for (std::size_t joint = 0; joint < 3; ++joint) put(message, kAttributes + joint, counts[joint]);
  return message;
}

}  // namespace haptic::drivers::polhem
