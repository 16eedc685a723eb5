// Datagrams over the loopback of this machine.

#include <gtest/gtest.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <string>
#include <thread>

#include "drivers/device_error.h"
#include "drivers/io/udp/udp_socket.h"
#include "drivers/polhem/polhem_device.h"
#include "tests/support/device_life.h"
#include "tests/unit/drivers/polhem/polhem_messages.h"

namespace haptic::drivers::polhem {
namespace {

namespace asio = boost::asio;
using std::chrono::milliseconds;
using test::eventually;
using Udp = asio::ip::udp;

class Sender {
 public:
  explicit Sender(std::uint16_t port) : to_(asio::ip::address_v4::loopback(), port) {
    socket_.open(Udp::v4());
  }
  void send(const std::vector<std::uint8_t>& bytes) { socket_.send_to(asio::buffer(bytes), to_); }

 private:
  asio::io_context context_;
  Udp::socket socket_{context_};
  Udp::endpoint to_;
};

std::uint16_t free_port() { return io::UdpSocket(0).port(); }

TEST(UdpSocket, HearsTheFirstSenderOnly) {
  io::UdpSocket socket(0);
  Sender first(socket.port());
  Sender second(socket.port());
  std::array<std::uint8_t, 16> bytes{};
  EXPECT_EQ(socket.receive(bytes, milliseconds(5)), 0U);
  first.send({1, 2, 3});
  EXPECT_EQ(socket.receive(bytes, milliseconds(1000)), 3U);
  second.send({9, 9});
  EXPECT_EQ(socket.receive(bytes, milliseconds(1000)), 0U);
  first.send({4});
  EXPECT_EQ(socket.receive(bytes, milliseconds(1000)), 1U);
  EXPECT_EQ(bytes[0], 4);
}

TEST(UdpSocket, APortThatIsTakenIsToldByItsNumber) {
  const io::UdpSocket socket(0);
  try {
    const io::UdpSocket again(socket.port());
    FAIL() << "no exception";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(socket.port())), std::string::npos)
        << error.what();
  }
}

TEST(PolhemUdp, TellsWhereTheArmIsThroughGarbageAndSilence) {
  const std::uint16_t port = free_port();
  const std::unique_ptr<Device> device = make_polhem({.name = "arm", .udp_port = port});
  EXPECT_EQ(device->info().max_force, 0.0) << "positions only";
  device->start();
  EXPECT_EQ(test::why_not_open(*device), "nothing is heard from it on UDP port " + std::to_string(port));
  Sender arm(port);
  DeviceSample sample;
  ASSERT_TRUE(eventually([&] {
    arm.send({0xA4, 0x17});
    arm.send(datagram(0, 0, 6000));
    return device->read(0, sample);
  }));
  EXPECT_NEAR(sample.position.z, 0.205, 1e-12);
  EXPECT_TRUE(test::reaches(*device, DevicePhase::kAbsent)) << "silent";
  EXPECT_GE(device->state().losses, 1U);
  EXPECT_FALSE(device->read(0, sample));
  EXPECT_TRUE(eventually([&] {
    arm.send(datagram(0, 0, 6000));
    return device->read(0, sample);
  }));
  device->stop();
}

TEST(PolhemUdp, APortThatIsTakenIsToldAtTheStart) {
  const io::UdpSocket socket(0);
  const std::unique_ptr<Device> device = make_polhem({.name = "arm", .udp_port = socket.port()});
  EXPECT_THROW(device->start(), DeviceError);
}

}  // namespace
}  // namespace haptic::drivers::polhem
