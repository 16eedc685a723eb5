#include "drivers/phantom/phantom_device.h"

#include <system_error>
#include <thread>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/io/udev/udev_monitor.h"
#include "drivers/phantom/phantom_watchdog.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::phantom {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kIdle{50};           // between two looks at the stop flag, where nothing is done
constexpr milliseconds kLastInterrupt{20};  // that is waited for on the way out
constexpr int kLastInterrupts = 2;

class PhantomRoutine final : public DeviceRoutine {
 public:
  explicit PhantomRoutine(PhantomSettings settings) : settings_(std::move(settings)) {}

  void open() override {
    try {
      card_.emplace(settings_.path);
      if (!settings_.calibration) return;
      if (gives_force()) {
        // what the kernel still holds is what the last program wrote
        write_nothing();
        card_->hold_outputs();
        write_nothing();
      }
      card_->start();
    } catch (const DeviceError&) {
      card_.reset();
      throw;
    }
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    if (!settings_.calibration) {
      life().tell(DevicePhase::kOpening, "it has no calibration (phantom.calibration of the config)");
      while (!stop.is_raised()) std::this_thread::sleep_for(kIdle);
      return;
    }
    try {
      serve(link, stop);
    } catch (...) {
      let_go();
      throw;
    }
    let_go();
  }

  void close() noexcept override { card_.reset(); }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_udev("phantom"); }

 private:
  bool gives_force() const { return settings_.calibration && settings_.max_force > 0.0; }

  void serve(DeviceLink& link, const StopFlag& stop) {
    const std::unique_ptr<Watchdog> watchdog = gives_force() ? watch() : nullptr;
    PhantomControl control({.calibration = *settings_.calibration,
                            .max_force = settings_.max_force,
                            .reading_age = std::chrono::nanoseconds(settings_.patience).count() / 2});
    const RegisterMask inputs = inputs_of(settings_.calibration->map);
    const RegisterMask outputs = outputs_of(settings_.calibration->map);
    Nanoseconds last = rt::monotonic_ns();
    const Nanoseconds silence = std::chrono::nanoseconds(settings_.silence).count();
    // half of the patience, so that a card that is silent is not taken for a thread that hangs
    const milliseconds wait = settings_.patience / 2;
    while (!stop.is_raised()) {
      const bool has_come = card_->wait(wait);
      if (has_come) control.take(card_->read(inputs), rt::monotonic_ns());
      const Nanoseconds now = rt::monotonic_ns();
      if (gives_force()) {
        if (watchdog->has_tripped()) throw DeviceError("a round lasted too long, and force was ended");
        card_->write(outputs, control.next_outputs(link.live_force(now), now));
        // it may have tripped between the two: then what was written now is not the last word
        if (watchdog->has_tripped()) write_nothing();
        watchdog->beat();
      }
      if (has_come) {
        last = now;
        if (control.sample()) {
          link.publish(*control.sample());
        } else {
          link.publish_nothing();
        }
      } else {
        if (control.hold(now) == Hold::kNoReading) link.publish_nothing();
        if (now - last >= silence) throw DeviceError(settings_.path + ": its interrupts have ended");
      }
    }
  }

  std::unique_ptr<Watchdog> watch() {
    try {
      return std::make_unique<Watchdog>(settings_.patience, [this] {
        try {
          write_nothing();
        } catch (const DeviceError&) {
          // the card is out of reach
        }
      });
    } catch (const std::system_error& error) {
      throw DeviceError(std::string("its watchdog cannot be made: ") + error.what());
    }
  }

  void write_nothing() { card_->write(outputs_of(settings_.calibration->map), no_torque()); }

  /// Each step for itself: one that fails must not keep the next from being tried.
  void let_go() noexcept {
    const auto attempt = [](auto&& act) noexcept {
      try {
        act();
      } catch (const DeviceError&) {
        // the next step may still reach it
      }
    };
    if (!gives_force()) return attempt([this] { card_->stop(); });
    attempt([this] {
      write_nothing();
      const RegisterMask inputs = inputs_of(settings_.calibration->map);
      for (int i = 0; i < kLastInterrupts; ++i) {
        (void)card_->read(inputs);  // forgets the interrupts so far
        if (!card_->wait(kLastInterrupt)) break;
      }
    });
    attempt([this] { card_->stop(); });
    card_.reset();
    attempt([this] {
      card_.emplace(settings_.path);
      write_nothing();
      card_->stop();
    });
  }

  PhantomSettings settings_;
  std::optional<io::PhantomCard> card_;
};

}  // namespace

std::unique_ptr<Device> make_phantom(PhantomSettings settings) {
  DeviceInfo info{.name = settings.name,
                  .driver = "phantom",
                  .max_force = settings.calibration ? settings.max_force : 0.0};
  const BasePose base = settings.world_from_base;
  return std::make_unique<ThreadedDevice>(std::move(info), base,
                                          std::make_unique<PhantomRoutine>(std::move(settings)));
}

}  // namespace haptic::drivers::phantom
