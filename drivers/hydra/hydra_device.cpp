#include "drivers/hydra/hydra_device.h"

#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/hydra/hydra_protocol.h"
#include "drivers/io/hid/hid.h"
#include "drivers/io/udev/udev_monitor.h"
#include "drivers/velocity_estimate.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::hydra {

namespace {

constexpr std::uint16_t kVendor = 0x1532;
constexpr std::uint16_t kProduct = 0x0300;
constexpr int kMotionInterface = 0;
constexpr int kControlInterface = 1;

// reports come every 4 ms; the stop flag is looked at in between
constexpr std::chrono::milliseconds kPatience{20};
constexpr double kVelocityLag = 0.012;  // s, three reports
// without a report for so long the base is in gamepad mode again, or gone
constexpr Nanoseconds kLongestSilence = 500'000'000;

io::HidInfo interface_of(int number) {
  return io::find_hid("Razer Hydra", [=](const io::HidInfo& info) {
    return info.vendor == kVendor && info.product == kProduct && info.interface_number == number;
  });
}

class HydraRoutine final : public DeviceRoutine {
 public:
  explicit HydraRoutine(HydraSettings settings) : settings_(std::move(settings)) {}

  void open() override {
    try {
      const io::HidInfo found = interface_of(kMotionInterface);
      motion_.emplace(found);
      life().tell_serial(found.serial);
      life().tell(DevicePhase::kOpening, "it is turned from gamepad to motion");
      if (sends_motion(settings_.first_report)) return;
      io::HidDevice control(interface_of(kControlInterface));
      for (int attempt = 0; attempt < settings_.attempts; ++attempt) {
        control.send_feature(mode_report(Mode::kMotion));
        std::array<std::uint8_t, kFeatureBytes> answer{};
        (void)control.get_feature(answer);  // it wants to be asked
        if (sends_motion(settings_.mode_change)) return;
      }
      throw DeviceError("the Razer Hydra sends no motion: unplug it and plug it in again");
    } catch (const DeviceError&) {
      motion_.reset();
      throw;
    }
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    VelocityEstimate velocity(kVelocityLag);
    Nanoseconds last = rt::monotonic_ns();
    while (!stop.is_raised()) {
      std::array<std::uint8_t, kReportBytes + 12> report{};
      const std::size_t length = motion_->read(report, kPatience);
      const Nanoseconds now = rt::monotonic_ns();
      if (length == 0) {
        if (now - last > kLongestSilence) throw DeviceError("it sends no motion any more");
        continue;
      }
      last = now;
      const std::optional<Wand> wand = decode(std::span(report).first(length), settings_.wand);
      if (!wand) continue;
      link.publish({.time = now,
                    .position = wand->position,
                    .orientation = wand->orientation,
                    .velocity = velocity.take(now, wand->position),
                    .buttons = wand->buttons});
    }
  }

  // the other wand may be in use: the base goes on sending motion
  void close() noexcept override { motion_.reset(); }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_udev("hidraw"); }

 private:
  bool sends_motion(std::chrono::milliseconds wait) {
    const Nanoseconds give_up = rt::monotonic_ns() + std::chrono::nanoseconds(wait).count();
    while (rt::monotonic_ns() < give_up) {
      go_on();
      std::array<std::uint8_t, kReportBytes + 12> report{};
      if (motion_->read(report, kPatience) == kReportBytes) return true;
    }
    return false;
  }

  HydraSettings settings_;
  std::optional<io::HidDevice> motion_;
};

}  // namespace

std::unique_ptr<Device> make_hydra(HydraSettings settings) {
  DeviceInfo info{.name = settings.name,
                  .driver = "hydra",
                  .max_force = std::numeric_limits<double>::infinity(),
                  .exerts_force = false};
  const BasePose base = settings.world_from_base;
  return std::make_unique<ThreadedDevice>(std::move(info), base,
                                          std::make_unique<HydraRoutine>(std::move(settings)));
}

}  // namespace haptic::drivers::hydra
