#include "drivers/fastrak/fastrak_device.h"

#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/device_error.h"
#include "drivers/fastrak/fastrak_protocol.h"
#include "drivers/io/serial/serial_port.h"
#include "drivers/io/udev/udev_monitor.h"
#include "drivers/velocity_estimate.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::fastrak {

namespace {

constexpr std::chrono::milliseconds kPatience{20};
constexpr std::chrono::milliseconds kStatusWait{500};
constexpr double kVelocityLag = 0.02;  // s, some two records

class FastrakRoutine final : public DeviceRoutine {
 public:
  explicit FastrakRoutine(FastrakSettings settings) : settings_(std::move(settings)) {}

  void open() override {
    try {
      port_.emplace(settings_.port, settings_.baud);
      life().tell(DevicePhase::kOpening, "it is asked who it is");
      send(kSilence);
      std::this_thread::sleep_for(settings_.settle);
      port_->drain(settings_.command);
      require_status();
      start_records();
    } catch (const DeviceError&) {
      port_.reset();
      throw;
    }
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    RecordParser parser;
    VelocityEstimate velocity(kVelocityLag);
    const Nanoseconds longest = std::chrono::nanoseconds(settings_.silence).count();
    Nanoseconds last = rt::monotonic_ns();
    while (!stop.is_raised()) {
      std::array<std::uint8_t, 256> bytes{};
      const std::size_t count = port_->read_some(bytes, kPatience);
      const Nanoseconds now = rt::monotonic_ns();
      Record record;
      for (std::size_t i = 0; i < count; ++i) {
        if (!parser.take(bytes[i], record) || record.station != settings_.station) continue;
        last = now;
        // one with an error was not measured: the sample grows old
        if (record.error != ' ') continue;
        link.publish({.time = now,
                      .position = record.position,
                      .orientation = record.orientation,
                      .velocity = velocity.take(now, record.position)});
      }
      if (now - last <= longest) continue;
      link.publish_nothing();
      if (life().state().phase == DevicePhase::kReady) {
        life().lose(DevicePhase::kOpening, "it fell silent, and is asked to send again; is it switched on?");
      }
      start_records();  // it may have been switched off and on
      last = rt::monotonic_ns();
    }
  }

  void close() noexcept override {
    try {
      if (port_) send(kSilence);
    } catch (const DeviceError&) {
      // it is gone, and silent
    }
    port_.reset();
  }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_udev("tty"); }

 private:
  void send(std::string_view command) {
    port_->write({reinterpret_cast<const std::uint8_t*>(command.data()), command.size()});
  }

  void require_status() {
    send(kStatus);
    std::vector<std::uint8_t> answer;
    std::array<std::uint8_t, 64> bytes{};
    while (!is_status(answer)) {
      go_on();
      const std::size_t count = port_->read_some(bytes, kStatusWait);
      answer.insert(answer.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
      constexpr std::size_t kMost = 1024;
      if (count > 0 && answer.size() < kMost) continue;
      throw DeviceError(settings_.port +
                        (answer.empty() ? ": nothing answers" : ": what answers is no FASTRAK") +
                        "; is its rate " + std::to_string(settings_.baud) + " baud?");
    }
  }

  void start_records() {
    for (const std::string& command : start_commands(settings_.station, settings_.hemisphere)) {
      send(command);
      std::this_thread::sleep_for(settings_.command);
    }
  }

  FastrakSettings settings_;
  std::optional<io::SerialPort> port_;
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
