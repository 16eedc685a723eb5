// usage: emulated_falcon [FIRMWARE]
//
// A Falcon on the USB of the machine that it runs on, which a test moves and feels by lines on standard
// input:
//
//     plug                  with its power, so that it needs its firmware (if FILE is given) and homing
//     unplug
//     hold X Y Z [SECONDS]  the grip, m, its own frame; moved there in a straight line
//     homed BITS            which encoders have passed their marks
//     report
//
// Each is answered with one line of JSON: what it has seen so far, or "error". The end of the input unplugs
// it.

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <glm/common.hpp>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "drivers/falcon/falcon_kinematics.h"
#include "tests/support/falcon_emulator.h"
#include "tests/system/usbip_device.h"

namespace haptic::test {
namespace {

using Clock = UsbipDevice::Clock;

class Table {
 public:
  explicit Table(std::vector<std::uint8_t> firmware)
      : firmware_(std::move(firmware)),
        falcon_(firmware_),
        usb_({.vendor = 0x0403, .product = 0xcb48, .serial = "FALCON01"},
             {.control = [this](std::uint8_t request,
                                std::uint16_t value) { falcon_.control(request, value); },
              .out = [this](std::span<const std::uint8_t> bytes) { falcon_.receive(bytes); },
              .in = [this](std::size_t most) { return falcon_.send(most); }}) {
    falcon_.hold_at(to_);
  }

  /// What the line asks for; throws std::runtime_error if it cannot be had.
  void obey(const std::string& line) {
    std::istringstream words(line);
    std::string verb;
    words >> verb;
    if (verb == "plug") {
      falcon_ = FalconEmulator(firmware_);
      falcon_.hold_at(to_);
      usb_.plug_in();
    } else if (verb == "unplug") {
      usb_.unplug();
    } else if (verb == "hold") {
      hold(words);
    } else if (verb == "homed") {
      unsigned bits = 0;
      if (!(words >> bits)) throw std::runtime_error("homed needs bits");
      falcon_.set_homed(bits);
    } else if (verb != "report") {
      throw std::runtime_error("there is no verb \"" + verb + "\"");
    }
  }

  std::string report() const {
    const glm::dvec3 force = falcon_.force();
    return fmt::format(
        R"({{"plugged": {}, "running": {}, "packets": {}, "broken": {}, "flags": {}, "motors": [{}, {}, {}], )"
        R"("force": [{}, {}, {}]}})",
        usb_.descriptor() >= 0, falcon_.stage() == FalconEmulator::Stage::kRunning, falcon_.packets(),
        falcon_.broken_bytes(), falcon_.flags(), falcon_.motors()[0], falcon_.motors()[1],
        falcon_.motors()[2], force.x, force.y, force.z);
  }

  UsbipDevice& usb() { return usb_; }

  void advance(Clock::time_point now) {
    const double share =
        duration_ > 0.0
            ? std::clamp(std::chrono::duration<double>(now - begin_).count() / duration_, 0.0, 1.0)
            : 1.0;
    falcon_.hold_at(glm::mix(from_, to_, share));
    usb_.advance(now);
  }

 private:
  void hold(std::istringstream& words) {
    glm::dvec3 to(0.0);
    if (!(words >> to.x >> to.y >> to.z)) throw std::runtime_error("hold needs three coordinates");
    if (!drivers::falcon::inverse_kinematics(to)) throw std::runtime_error("the grip cannot be held there");
    double seconds = 0.0;
    words >> seconds;
    from_ = std::exchange(to_, to);
    begin_ = Clock::now();
    duration_ = seconds;
  }

  std::vector<std::uint8_t> firmware_;
  FalconEmulator falcon_;
  UsbipDevice usb_;
  glm::dvec3 from_ = drivers::falcon::kCentre;
  glm::dvec3 to_ = drivers::falcon::kCentre;
  Clock::time_point begin_{};
  double duration_ = 0.0;
};

void answer(Table& table, const std::string& line) {
  try {
    table.obey(line);
    fmt::print("{}\n", table.report());
  } catch (const std::runtime_error& error) {
    fmt::print("error: {}\n", error.what());
  }
  std::fflush(stdout);
}

/// Until the input ends.
void serve(Table& table) {
  std::string input;
  while (true) {
    std::array<pollfd, 2> wanted{pollfd{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0},
                                 pollfd{.fd = table.usb().descriptor(), .events = POLLIN, .revents = 0}};
    if (::poll(wanted.data(), wanted.size(), 1) < 0 && errno != EINTR)
      throw std::runtime_error("poll failed");
    if (wanted[0].revents != 0) {
      std::array<char, 256> block{};
      const ssize_t count = ::read(STDIN_FILENO, block.data(), block.size());
      if (count <= 0) return;
      input.append(block.data(), static_cast<std::size_t>(count));
      for (std::size_t end = input.find('\n'); end != std::string::npos; end = input.find('\n')) {
        answer(table, input.substr(0, end));
        input.erase(0, end + 1);
      }
    }
    if (wanted[1].revents != 0 && table.usb().descriptor() == wanted[1].fd) table.usb().serve();
    table.advance(Clock::now());
  }
}

std::vector<std::uint8_t> read_file(const char* path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(std::string(path) + " cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace
}  // namespace haptic::test

int main(int argc, char** argv) {
  try {
    haptic::test::Table table(argc > 1 ? haptic::test::read_file(argv[1]) : std::vector<std::uint8_t>{});
    haptic::test::serve(table);
    return 0;
  } catch (const std::exception& error) {
    (void)std::fprintf(stderr, "emulated_falcon: %s\n", error.what());
    return 1;
  }
}
