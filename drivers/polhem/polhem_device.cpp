#include "drivers/polhem/polhem_device.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/io/hid/hid.h"
#include "drivers/io/udev/udev_monitor.h"
#include "drivers/io/udp/udp_socket.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::polhem {

namespace {

constexpr std::size_t kLongReport = 64;
constexpr std::chrono::milliseconds kPatience{10};  // then the arm is told something, to get it going
constexpr Nanoseconds kLongestSilence = 100'000'000;
constexpr int kMostWaiting = 32;  // reports that are passed over for the newest
constexpr int kLastMessages = 5;

void publish(const PolhemControl& control, DeviceLink& link) noexcept {
  if (control.sample()) {
    link.publish(*control.sample());
  } else {
    link.publish_nothing();
  }
}

void fall_silent(DeviceLink& link, DeviceLife& life, DevicePhase phase) {
  link.publish_nothing();
  if (life.state().phase == DevicePhase::kReady) life.lose(phase, "it fell silent");
}

class UsbRoutine final : public DeviceRoutine {
 public:
  explicit UsbRoutine(PolhemSettings settings) : settings_(std::move(settings)) {}

  void open() override {
    const io::HidInfo found = io::find_hid("WoodenHaptics arm", [&](const io::HidInfo& info) {
      return info.vendor == settings_.vendor && info.product == settings_.product;
    });
    hid_.emplace(found);
    life().tell_serial(found.serial);
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    PolhemControl control(settings_.control);
    Nanoseconds last = rt::monotonic_ns();
    while (!stop.is_raised()) {
      const std::optional<Reading> reading = newest();
      const Nanoseconds now = rt::monotonic_ns();
      if (life().take(DeviceAction::kCalibrate)) control.calibrate();
      if (!reading) {
        if (now - last > kLongestSilence) fall_silent(link, life(), DevicePhase::kOpening);
        send(currents_message({}));
        continue;
      }
      last = now;
      control.take(*reading, now);
      publish(control, link);
      note_calibration(control);
      send(control.answer(link.live_force(now)));
    }
    for (int i = 0; i < kLastMessages; ++i) send(currents_message({}));
  }

  void close() noexcept override { hid_.reset(); }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_udev("hidraw"); }

  bool knows(DeviceAction action) const noexcept override { return action == DeviceAction::kCalibrate; }

 private:
  void note_calibration(const PolhemControl& control) {
    if (control.sample()) {
      // it is in its rest pose when the daemon starts; when it is plugged in again a hand may hold it
      // anywhere
      settings_.control.calibrate_at_start = false;
    } else if (life().state().phase != DevicePhase::kHoming) {
      life().tell(DevicePhase::kHoming,
                  "put it into its rest pose, then press its button or run `hapticctl devices calibrate`");
    }
  }

  /// The newest of the reports that are there; nothing if none comes.
  std::optional<Reading> newest() {
    std::optional<Reading> reading;
    std::chrono::milliseconds patience = kPatience;
    for (int i = 0; i < kMostWaiting; ++i) {
      std::array<std::uint8_t, kLongReport> report{};
      const std::size_t length = hid_->read(report, patience);
      if (length == 0) break;
      is_long_ = length > kMessageBytes;
      if (const auto newer = decode_report(std::span(report).first(length))) reading = newer;
      patience = std::chrono::milliseconds(0);
    }
    return reading;
  }

  /// As long as what the arm sends, after the report id that it does not have.
  void send(const Message& message) {
    std::array<std::uint8_t, 1 + kLongReport> report{};
    std::copy(message.begin(), message.end(), report.begin() + 1);
    hid_->write(std::span(report).first(1 + (is_long_ ? kLongReport : kMessageBytes)));
  }

  PolhemSettings settings_;
  std::optional<io::HidDevice> hid_;
  bool is_long_ = true;
};

class UdpRoutine final : public DeviceRoutine {
 public:
  explicit UdpRoutine(PolhemSettings settings) : settings_(std::move(settings)) {
    settings_.control.presets_itself = false;
  }

  void prepare() override { socket_.emplace(settings_.udp_port); }

  void open() override {}

  void run(DeviceLink& link, const StopFlag& stop) override {
    PolhemControl control(settings_.control);
    Nanoseconds last = rt::monotonic_ns();
    life().tell(DevicePhase::kAbsent,
                "nothing is heard from it on UDP port " + std::to_string(settings_.udp_port));
    while (!stop.is_raised()) {
      std::array<std::uint8_t, 2 * kDatagramBytes> datagram{};
      const std::size_t length = socket_->receive(datagram, kPatience);
      const Nanoseconds now = rt::monotonic_ns();
      const std::optional<Reading> reading = decode_datagram(std::span(datagram).first(length));
      if (reading) {
        last = now;
        control.take(*reading, now);
        publish(control, link);
      } else if (now - last > kLongestSilence) {
        fall_silent(link, life(), DevicePhase::kAbsent);
      }
    }
  }

  void close() noexcept override {}

  void release() noexcept override { socket_.reset(); }

 private:
  PolhemSettings settings_;
  std::optional<io::UdpSocket> socket_;
};

}  // namespace

std::unique_ptr<Device> make_polhem(PolhemSettings settings) {
  const bool is_udp = settings.udp_port != 0;
  DeviceInfo info{.name = settings.name,
                  .driver = "polhem",
                  .max_force = is_udp ? 0.0 : settings.control.max_force,
                  .exerts_force = !is_udp};
  const BasePose base = settings.world_from_base;
  std::unique_ptr<DeviceRoutine> routine;
  if (is_udp) {
    routine = std::make_unique<UdpRoutine>(std::move(settings));
  } else {
    routine = std::make_unique<UsbRoutine>(std::move(settings));
  }
  return std::make_unique<ThreadedDevice>(std::move(info), base, std::move(routine));
}

}  // namespace haptic::drivers::polhem
