#pragma once
// A serial port without hardware: a pair of pseudo-terminals, of which a driver opens one by its path and a
// test is the other end.

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptic::test {

class SerialMock {
 public:
  SerialMock() {
    std::array<char, 128> name{};
    if (::openpty(&ours_, &theirs_, name.data(), nullptr, nullptr) != 0) {
      throw std::runtime_error("no pseudo-terminals");
    }
    // raw before anybody writes: what came before would be echoed. Theirs stays open, so that ours lives on
    // between two openings of the driver
    termios settings{};
    ::tcgetattr(theirs_, &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(theirs_, TCSANOW, &settings);
    ::fcntl(ours_, F_SETFL, O_NONBLOCK);
    path_ = name.data();
  }
  ~SerialMock() { unplug(); }
  SerialMock(const SerialMock&) = delete;
  SerialMock& operator=(const SerialMock&) = delete;

  const std::string& path() const { return path_; }

  /// The device sends.
  void send(std::span<const std::uint8_t> bytes) const {
    if (::write(ours_, bytes.data(), bytes.size()) < 0 && errno != EAGAIN && ours_ >= 0) {
      throw std::runtime_error("the pseudo-terminal takes nothing");
    }
  }

  /// What the driver has sent, after up to 2 ms.
  std::vector<std::uint8_t> receive() const {
    pollfd ready{.fd = ours_, .events = POLLIN, .revents = 0};
    if (::poll(&ready, 1, 2) <= 0) return {};
    std::vector<std::uint8_t> bytes(4096);
    const ssize_t count = ::read(ours_, bytes.data(), bytes.size());
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

  /// From now on the port is gone.
  void unplug() {
    if (ours_ >= 0) ::close(ours_);
    if (theirs_ >= 0) ::close(theirs_);
    ours_ = theirs_ = -1;
  }

 private:
  int ours_ = -1;
  int theirs_ = -1;
  std::string path_;
};

}  // namespace haptic::test
