#include "drivers/spacemouse/spacemouse_device.h"

#include <array>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/io/hid/hid.h"
#include "drivers/io/udev/udev_monitor.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::spacemouse {

namespace {

// the pose moves on between reports too, which come every 8 or 16 ms
constexpr std::chrono::milliseconds kStep{4};

constexpr Nanoseconds kIdentifying = 3'000'000'000;
constexpr Nanoseconds kBlink = 250'000'000;

constexpr std::uint16_t kGenericDesktop = 1;
constexpr std::uint16_t kMultiAxisController = 8;

bool is_spacemouse(const io::HidInfo& info) {
  const bool is_maker = info.vendor == 0x046d || info.vendor == 0x256f;
  return is_maker && info.usage_page == kGenericDesktop && info.usage == kMultiAxisController;
}

class SpacemouseRoutine final : public DeviceRoutine {
 public:
  explicit SpacemouseRoutine(SpacemouseSettings settings) : settings_(std::move(settings)) {}

  void open() override {
    const std::string& serial = settings_.serial;
    const io::HidInfo found = io::find_hid(
        "SpaceMouse" + (serial.empty() ? serial : " with serial " + serial), [&](const io::HidInfo& info) {
          return is_spacemouse(info) && (serial.empty() || info.serial == serial);
        });
    hid_.emplace(found);
    life().tell_serial(found.serial);
    light(true);
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    Decoder decoder;
    Motion motion(settings_.motion);
    Nanoseconds identified_until = 0;
    bool is_lit = true;
    while (!stop.is_raised()) {
      std::array<std::uint8_t, 64> report{};
      const std::size_t length = hid_->read(report, kStep);
      const Nanoseconds now = rt::monotonic_ns();
      if (life().take(DeviceAction::kIdentify)) identified_until = now + kIdentifying;
      const bool shall_light = now >= identified_until || now / kBlink % 2 == 0;
      if (shall_light != is_lit) light(shall_light);
      is_lit = shall_light;
      if (decoder.take(std::span(report).first(length)) != Report::kUnknown) motion.take(decoder, now);
      if (const std::optional<DeviceSample> sample = motion.advance(now)) {
        link.publish(*sample);
      } else {
        link.publish_nothing();
      }
    }
  }

  void close() noexcept override {
    light(false);
    hid_.reset();
  }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_udev("hidraw"); }

  bool knows(DeviceAction action) const noexcept override { return action == DeviceAction::kIdentify; }

 private:
  void light(bool on) noexcept {
    try {
      hid_->write(std::array<std::uint8_t, 2>{4, static_cast<std::uint8_t>(on ? 1 : 0)});
    } catch (const DeviceError&) {
      // models without a LED refuse it, and one that was unplugged has none
    }
  }

  SpacemouseSettings settings_;
  std::optional<io::HidDevice> hid_;
};

}  // namespace

std::unique_ptr<Device> make_spacemouse(SpacemouseSettings settings) {
  DeviceInfo info{.name = settings.name,
                  .driver = "spacemouse",
                  .max_force = std::numeric_limits<double>::infinity(),
                  .exerts_force = false};
  const BasePose base = settings.world_from_base;
  return std::make_unique<ThreadedDevice>(std::move(info), base,
                                          std::make_unique<SpacemouseRoutine>(std::move(settings)));
}

}  // namespace haptic::drivers::spacemouse
