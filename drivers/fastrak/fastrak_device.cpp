#include "drivers/fastrak/fastrak_device.h"

#include <limits>
#include <optional>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/io/udev/udev_monitor.h"
#include "drivers/velocity_estimate.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::fastrak {

namespace {

constexpr std::chrono::milliseconds kPatience{20};
constexpr double kVelocityLag = 0.02;  // s, some two records

class FastrakRoutine final : public DeviceRoutine {
 public:
  explicit FastrakRoutine(FastrakSettings settings)
      : settings_(std::move(settings)), line_(line_on(settings_.line)) {}

  void open() override {
    line_->join(settings_.station, [this] {
      life().tell(DevicePhase::kOpening, "it is asked who it is");
      go_on();
    });
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    VelocityEstimate velocity(kVelocityLag);
    const Nanoseconds longest = std::chrono::nanoseconds(settings_.line.silence).count();
    Nanoseconds last = rt::monotonic_ns();
    while (!stop.is_raised()) {
      if (const std::optional<Arrival> arrival = line_->receive(settings_.station.number, kPatience)) {
        last = arrival->time;
        const Record& record = arrival->record;
        // one with an error was not measured: the sample grows old
        if (record.error != ' ') continue;
        link.publish({.time = arrival->time,
                      .position = record.position,
                      .orientation = record.orientation,
                      .velocity = velocity.take(arrival->time, record.position)});
      }
      if (rt::monotonic_ns() - last <= longest) continue;
      link.publish_nothing();
      if (life().state().phase == DevicePhase::kReady) {
        life().lose(DevicePhase::kOpening, "it fell silent, and is asked to send again; is it switched on?");
      }
      line_->start_again();
      last = rt::monotonic_ns();
    }
  }

  void close() noexcept override { line_->leave(settings_.station.number); }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_udev("tty"); }

 private:
  FastrakSettings settings_;
  std::shared_ptr<TrackerLine> line_;
};

}  // namespace

std::unique_ptr<Device> make_fastrak(FastrakSettings settings) {
  DeviceInfo info{.name = settings.name,
                  .driver = "fastrak",
                  .max_force = std::numeric_limits<double>::infinity(),
                  .exerts_force = false};
  const BasePose base = settings.world_from_base;
  return std::make_unique<ThreadedDevice>(std::move(info), base,
                                          std::make_unique<FastrakRoutine>(std::move(settings)));
}

}  // namespace haptic::drivers::fastrak
