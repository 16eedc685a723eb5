#include "drivers/io/udp/udp_socket.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <optional>
#include <string>

#include "drivers/device_error.h"

namespace haptic::drivers::io {

namespace asio = boost::asio;
using Udp = asio::ip::udp;

struct UdpSocket::Socket {
  asio::io_context context{1};
  Udp::socket socket{context};
  std::optional<Udp::endpoint> peer;
};

UdpSocket::UdpSocket(std::uint16_t port) : socket_(std::make_unique<Socket>()) {
  boost::system::error_code error;
  socket_->socket.open(Udp::v4(), error);
  if (!error) socket_->socket.bind(Udp::endpoint(Udp::v4(), port), error);
  if (error) throw DeviceError("UDP port " + std::to_string(port) + ": " + error.message());
}

UdpSocket::~UdpSocket() = default;

std::uint16_t UdpSocket::port() const { return socket_->socket.local_endpoint().port(); }

std::size_t UdpSocket::receive(std::span<std::uint8_t> bytes, std::chrono::milliseconds timeout) {
  bool done = false;
  boost::system::error_code failure;
  std::size_t count = 0;
  Udp::endpoint sender;
  socket_->socket.async_receive_from(asio::buffer(bytes.data(), bytes.size()), sender,
                                     [&](const boost::system::error_code& error, std::size_t length) {
                                       done = true;
                                       failure = error;
                                       count = length;
                                     });
  socket_->context.restart();
  socket_->context.run_for(timeout);
  if (!done) {
    socket_->socket.cancel();
    socket_->context.restart();
    socket_->context.run();
  }
  if (failure == asio::error::operation_aborted) return 0;
  if (failure) throw DeviceError("receiving over UDP: " + failure.message());
  if (!socket_->peer) socket_->peer = sender;
  return sender == *socket_->peer ? count : 0;
}

}  // namespace haptic::drivers::io
