#pragma once
// The USB-to-serial bridge in front of a Falcon's processor: FTDI's vendor requests, as far as they are used,
// and the two status bytes that it puts before the data of each USB packet.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptic::drivers::falcon {

inline constexpr std::uint8_t kEndpointIn = 0x81;
inline constexpr std::uint8_t kEndpointOut = 0x02;
inline constexpr std::size_t kUsbPacketBytes = 64;
inline constexpr std::size_t kStatusBytes = 2;

/// A vendor request: bRequest and wValue.
struct FtdiRequest {
  std::uint8_t request;
  std::uint16_t value;
};

inline constexpr FtdiRequest kPurgeReceived{0x00, 1};
inline constexpr FtdiRequest kPurgeSent{0x00, 2};
inline constexpr FtdiRequest kDtrLow{0x01, 0x0100};
inline constexpr FtdiRequest kDtrHigh{0x01, 0x0101};
inline constexpr FtdiRequest kRtsLow{0x01, 0x0200};
inline constexpr FtdiRequest kNoFlowControl{0x02, 0};
inline constexpr FtdiRequest kLine8N1{0x04, 0x0008};
// divisors of 3 MHz: the lower 14 bits are whole, the upper two a fraction
inline constexpr FtdiRequest kBaudHandshake{0x03, 0x4138};  // 312.5: 9600
inline constexpr FtdiRequest kBaudUpload{0x03, 0x0015};     // 21: 142 857, called 140 000
inline constexpr FtdiRequest kBaudRun{0x03, 0x0002};        // 2: 1.5 million
inline constexpr FtdiRequest kLatency1ms{0x09, 1};
inline constexpr FtdiRequest kLatency16ms{0x09, 16};

/// The data of one USB transfer, which may hold several packets of up to 64 bytes, without status: calls
/// `sink(span)` for each run of it.
template <class Sink>
void strip_status(std::span<const std::uint8_t> transfer, Sink&& sink) {
  while (!transfer.empty()) {
    const std::span<const std::uint8_t> packet = transfer.first(std::min(transfer.size(), kUsbPacketBytes));
    if (packet.size() > kStatusBytes) sink(packet.subspan(kStatusBytes));
    transfer = transfer.subspan(packet.size());
  }
}

}  // namespace haptic::drivers::falcon
