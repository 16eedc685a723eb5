#include "drivers/falcon/falcon_device.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/io/usb/usb.h"
#include "drivers/io/usb/usb_monitor.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::falcon {

namespace {

constexpr std::uint16_t kVendor = 0x0403;
constexpr std::uint16_t kProduct = 0xcb48;
constexpr double kRateHz = 1000.0;

// m, its own frame: the grip moves in about 100 mm, and on the axis out to just past z = 0.18. What lies
// beyond this box is no grip but a count that is wrong; near its end the driver holds force back by itself.
constexpr glm::dvec3 kReachLow{-0.08, -0.08, 0.05};
constexpr glm::dvec3 kReachHigh{0.08, 0.08, 0.19};

// in flight: two to listen, so that one is ready while the other is looked at; three to send, as a packet
// takes up to 2 ms until its reply is there
constexpr std::size_t kReads = 2;
constexpr std::size_t kWrites = 3;

// without a reply for so long it has lost its power, and its firmware with it
constexpr Nanoseconds kLongestSilence = 1'000'000'000;

constexpr std::chrono::milliseconds kSendTimeout{1000};
constexpr int kLastPackets = 8;
constexpr Nanoseconds kLastPacketsWait = 100'000'000;
constexpr std::chrono::milliseconds kLastPacketTimeout{20};

class UsbFtdiPort final : public FtdiPort {
 public:
  /// `go_on` throws when bringing the device up shall end.
  UsbFtdiPort(io::UsbDevice& usb, std::function<void()> go_on) : usb_(usb), go_on_(std::move(go_on)) {}

  void control(const FtdiRequest& request) override {
    go_on_();
    usb_.control_out(request.request, request.value, 0);
  }

  void write(std::span<const std::uint8_t> bytes) override {
    go_on_();
    usb_.bulk_out(kEndpointOut, bytes, kSendTimeout);
  }

  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::milliseconds timeout) override {
    const Nanoseconds give_up = rt::monotonic_ns() + std::chrono::nanoseconds(timeout).count();
    while (waiting_.empty()) {
      go_on_();
      const Nanoseconds left = give_up - rt::monotonic_ns();
      if (left <= 0) return 0;
      std::array<std::uint8_t, kUsbPacketBytes> packet{};
      const std::chrono::milliseconds wait(left / 1'000'000 + 1);
      const std::size_t count = usb_.bulk_in(kEndpointIn, packet, wait);
      strip_status(std::span(packet).first(count), [&](std::span<const std::uint8_t> data) {
        waiting_.insert(waiting_.end(), data.begin(), data.end());
      });
    }
    const std::size_t count = std::min(bytes.size(), waiting_.size());
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(waiting_.begin(), end, bytes.begin());
    waiting_.erase(waiting_.begin(), end);
    return count;
  }

 private:
  io::UsbDevice& usb_;
  std::function<void()> go_on_;
  std::vector<std::uint8_t> waiting_;  // read, but not yet asked for
};

class FalconRoutine final : public DeviceRoutine {
 public:
  explicit FalconRoutine(FalconSettings settings) : settings_(std::move(settings)) {}

  void open() override {
    const io::UsbMatch match{.vendor = kVendor, .product = kProduct, .serial = settings_.serial};
    usb_.emplace(match);
    life().tell_serial(usb_->serial());
    life().tell(DevicePhase::kOpening, "its firmware is started");
    try {
      UsbFtdiPort port(*usb_, [this] { go_on(); });
      bring_up(port, settings_.firmware, settings_.boot);
    } catch (const DeviceError&) {
      const bool was_unplugged = usb_->is_gone();
      usb_.reset();
      if (was_unplugged) throw DeviceAbsent("it was unplugged while its firmware was started");
      throw;
    }
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    FalconControl control(settings_.control);
    const io::UsbReader reader(
        *usb_, kEndpointIn, kUsbPacketBytes, kReads,
        [&](std::span<const std::uint8_t> transfer) { take(control, link, transfer, rt::monotonic_ns()); });
    io::UsbWriter writer(*usb_, kEndpointOut, kPacketBytes, kWrites);
    rt::TickSchedule schedule(rt::monotonic_ns(), kRateHz);
    Nanoseconds heard = rt::monotonic_ns();
    bool is_silent = false;
    while (!stop.is_raised() && !usb_->is_gone() && !is_silent) {
      const Nanoseconds now = rt::monotonic_ns();
      obey_requests(control, now);
      if (now >= schedule.next_due_ns()) {
        schedule.advance(now);
        // if all buffers are in flight the device lags: the next packet will be newer
        writer.submit(control.next_packet(link.live_force(now), now));
        const Hold hold = control.hold(now);
        if (hold == Hold::kNotHomed) ask_for_homing(link);
        if (hold == Hold::kNoReply) {
          link.publish_nothing();
          is_silent = now - heard > kLongestSilence;
        } else {
          heard = now;
        }
      }
      usb_->wait(schedule.next_due_ns());
    }
    let_go(writer);
    if (usb_->is_gone()) throw DeviceError("unplugged");
    if (is_silent) throw DeviceError("it does not answer any more; is its power supply plugged in?");
  }

  void close() noexcept override { usb_.reset(); }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_usb(kVendor, kProduct); }

  bool knows(DeviceAction action) const noexcept override {
    return action == DeviceAction::kIdentify || action == DeviceAction::kHome;
  }

 private:
  void obey_requests(FalconControl& control, Nanoseconds now) {
    if (life().take(DeviceAction::kIdentify)) control.identify(now);
    if (life().take(DeviceAction::kHome)) control.home(now);
  }

  void ask_for_homing(DeviceLink& link) {
    if (life().state().phase == DevicePhase::kHoming) return;
    link.publish_nothing();
    life().tell(DevicePhase::kHoming, "pull its grip out to the stop and push it in again, once");
  }

  static void take(FalconControl& control, DeviceLink& link, std::span<const std::uint8_t> transfer,
                   Nanoseconds now) {
    const std::uint64_t before = control.replies();
    strip_status(transfer, [&](std::span<const std::uint8_t> data) { control.take(data, now); });
    if (control.replies() == before) return;
    if (control.sample()) {
      link.publish(*control.sample());
    } else {
      link.publish_nothing();
    }
  }

  /// What the firmware does when packets end is not known: it gets zero force several times, LEDs off.
  void let_go(io::UsbWriter& writer) noexcept {
    const Packet nothing = encode({});
    const Nanoseconds give_up = rt::monotonic_ns() + kLastPacketsWait;
    int sent = 0;
    while ((sent < kLastPackets || !writer.is_idle()) && rt::monotonic_ns() < give_up && !usb_->is_gone()) {
      if (sent < kLastPackets && writer.submit(nothing)) ++sent;
      usb_->wait(rt::monotonic_ns() + 1'000'000);
    }
    if (sent == kLastPackets) return;
    // a transfer that failed need not mean that the device is out of reach
    try {
      for (; sent < kLastPackets; ++sent) usb_->bulk_out(kEndpointOut, nothing, kLastPacketTimeout);
    } catch (const DeviceError&) {
      // it is
    }
  }

  FalconSettings settings_;
  std::optional<io::UsbDevice> usb_;
};

}  // namespace

std::unique_ptr<Device> make_falcon(FalconSettings settings) {
  DeviceInfo info{.name = settings.name,
                  .driver = "falcon",
                  .max_force = settings.control.max_force,
                  .travel_min = kReachLow,
                  .travel_max = kReachHigh};
  const BasePose base = settings.world_from_base;
  return std::make_unique<ThreadedDevice>(std::move(info), base,
                                          std::make_unique<FalconRoutine>(std::move(settings)));
}

}  // namespace haptic::drivers::falcon
