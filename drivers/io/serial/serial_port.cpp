#include "drivers/io/serial/serial_port.h"

#include <sys/ioctl.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/write.hpp>

#include "drivers/device_error.h"

namespace haptic::drivers::io {

namespace asio = boost::asio;

namespace {

constexpr std::chrono::milliseconds kWriteTimeout{1000};
constexpr std::chrono::seconds kLongestDrain{2};

}  // namespace

struct SerialPort::Port {
  std::string path;
  asio::io_context context{1};
  asio::serial_port serial{context};

  [[noreturn]] void fail(const std::string& what, const boost::system::error_code& error) const {
    throw DeviceError(path + ": " + what + ": " + error.message());
  }

  /// Runs the operation that was begun until its handler has set `done`, or cancels it after `timeout`.
  void run(const bool& done, std::chrono::milliseconds timeout) {
    context.restart();
    context.run_for(timeout);
    if (done) return;
    serial.cancel();
    context.restart();
    context.run();
  }
};

SerialPort::SerialPort(const std::string& path, unsigned baud) : port_(std::make_unique<Port>()) {
  using Serial = asio::serial_port_base;
  port_->path = path;
  boost::system::error_code error;
  port_->serial.open(path, error);
  if (error == boost::system::errc::no_such_file_or_directory ||
      error == boost::system::errc::no_such_device ||
      error == boost::system::errc::no_such_device_or_address) {
    throw DeviceAbsent(path + ": there is no such port; is the device plugged in?");
  }
  if (error == boost::system::errc::permission_denied) {
    throw DeviceError("no permission to open " + path +
                      ": let the user who runs hapticd join the group dialout");
  }
  if (error == boost::system::errc::device_or_resource_busy) {
    throw DeviceError(path + " is in use by another program");
  }
  if (error) port_->fail("cannot be opened", error);
  const auto set = [&](const auto& option) {
    port_->serial.set_option(option, error);
    if (error) port_->fail("cannot be set", error);
  };
  set(Serial::baud_rate(baud));
  set(Serial::character_size(8));
  set(Serial::parity(Serial::parity::none));
  set(Serial::stop_bits(Serial::stop_bits::one));
  set(Serial::flow_control(Serial::flow_control::none));
  // refused by what is no real port; then two could open it
  (void)::ioctl(port_->serial.native_handle(), TIOCEXCL);
}

SerialPort::~SerialPort() = default;

std::size_t SerialPort::read_some(std::span<std::uint8_t> bytes, std::chrono::milliseconds timeout) {
  bool done = false;
  boost::system::error_code failure;
  std::size_t count = 0;
  port_->serial.async_read_some(asio::buffer(bytes.data(), bytes.size()),
                                [&](const boost::system::error_code& error, std::size_t length) {
                                  done = true;
                                  failure = error;
                                  count = length;
                                });
  port_->run(done, timeout);
  if (failure && failure != asio::error::operation_aborted) port_->fail("reading", failure);
  return count;
}

void SerialPort::write(std::span<const std::uint8_t> bytes) {
  bool done = false;
  boost::system::error_code failure;
  asio::async_write(port_->serial, asio::buffer(bytes.data(), bytes.size()),
                    [&](const boost::system::error_code& error, std::size_t /*length*/) {
                      done = true;
                      failure = error;
                    });
  port_->run(done, kWriteTimeout);
  if (failure) port_->fail("sending", failure);
}

void SerialPort::drain(std::chrono::milliseconds quiet) {
  const auto give_up = std::chrono::steady_clock::now() + kLongestDrain;
  std::array<std::uint8_t, 256> nothing{};
  while (read_some(nothing, quiet) > 0 && std::chrono::steady_clock::now() < give_up) {
  }
}

}  // namespace haptic::drivers::io
