#pragma once
// Datagrams that come to a port of this machine, by Boost.Asio. It knows nothing of any device.
//
// One thread uses a socket at a time. Functions throw DeviceError. Not real-time safe.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace haptic::drivers::io {

class UdpSocket {
 public:
  /// Listens on every address; port 0: any port that is free.
  explicit UdpSocket(std::uint16_t port);
  ~UdpSocket();

  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  /// One datagram of the first sender that was heard; what others send is passed over. 0 if `timeout` passes
  /// without one.
  std::size_t receive(std::span<std::uint8_t> bytes, std::chrono::milliseconds timeout);

  std::uint16_t port() const;

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace haptic::drivers::io
