#include "drivers/haply/haply_device.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/io/serial/serial_port.h"
#include "drivers/io/udev/udev_monitor.h"
#include "drivers/velocity_estimate.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::haply {

namespace {

constexpr unsigned kBaud = 115200;  // of no effect on its USB port
constexpr std::chrono::milliseconds kQuiet{5};
constexpr int kFirstTries = 20;
constexpr int kLastMessages = 5;
constexpr Nanoseconds kLongestSilence = 1'000'000'000;
constexpr Nanoseconds kPeriod = 1'000'000;
constexpr double kVelocityLag = 0.004;  // s

class HaplyRoutine final : public DeviceRoutine {
 public:
  explicit HaplyRoutine(HaplySettings settings) : settings_(std::move(settings)) {}

  void open() override {
    try {
      port_.emplace(settings_.port, kBaud);
      port_->write(kReset);
      port_->drain(kQuiet);
      port_->write(setup_message(settings_.wiring));
      for (int i = 0; i < kFirstTries; ++i) {
        go_on();
        if (exchange({})) return;
      }
      throw DeviceError(settings_.port + ": no Haply board answers");
    } catch (const DeviceError&) {
      port_.reset();
      throw;
    }
  }

  void run(DeviceLink& link, const StopFlag& stop) override {
    VelocityEstimate velocity(kVelocityLag);
    std::array<double, 2> torques{};
    Nanoseconds due = rt::monotonic_ns();
    Nanoseconds heard = due;
    bool is_silent = false;
    while (!stop.is_raised() && !is_silent) {
      const std::optional<std::array<double, 2>> angles = exchange(torques);
      const Nanoseconds now = rt::monotonic_ns();
      if (angles) heard = now;
      is_silent = now - heard > kLongestSilence;
      const auto handle = angles ? handle_position(settings_.geometry, *angles) : std::nullopt;
      if (handle) {
        const glm::dvec3 position(*handle, 0.0);
        link.publish({.time = now, .position = position, .velocity = velocity.take(now, position)});
      } else {
        link.publish_nothing();
        velocity.reset();
      }
      due = std::max(due + kPeriod, now);
      wait_until(due);
      // as late as can be: the force that is sent is the newest, and still alive
      torques =
          angles ? torques_for(link.live_force(rt::monotonic_ns()).force, *angles) : std::array<double, 2>{};
    }
    for (int i = 0; i < kLastMessages; ++i) (void)exchange({});
    if (is_silent) throw DeviceError(settings_.port + ": the board does not answer any more");
  }

  void close() noexcept override { port_.reset(); }

  std::unique_ptr<PlugMonitor> make_monitor() override { return io::watch_udev("tty"); }

 private:
  /// Sends torques and gives the angles; nothing, and the stream begun anew, if no sound reply came.
  std::optional<std::array<double, 2>> exchange(const std::array<double, 2>& torques) {
    port_->write(request_message(torques));
    std::array<std::uint8_t, kReplyBytes> reply{};
    std::size_t count = 0;
    while (count < reply.size()) {
      const std::size_t more = port_->read_some(std::span(reply).subspan(count), settings_.reply);
      if (more == 0) break;
      count += more;
    }
    const auto angles = decode(std::span(reply).first(count));
    if (!angles) port_->drain(kQuiet);
    return angles;
  }

  std::array<double, 2> torques_for(const glm::dvec3& force, const std::array<double, 2>& angles) const {
    const double magnitude = glm::length(force);
    if (!(magnitude > 0.0)) return {};
    const glm::dvec3 limited = std::min(1.0, settings_.max_force / magnitude) * force;
    return arm_torques(settings_.geometry, angles, {limited.x, limited.y}).value_or(std::array<double, 2>{});
  }

  static void wait_until(Nanoseconds due) {
    const Nanoseconds left = due - rt::monotonic_ns();
    if (left <= 0) return;
    const timespec pause{.tv_sec = 0, .tv_nsec = static_cast<long>(left)};
    ::nanosleep(&pause, nullptr);
  }

  HaplySettings settings_;
  std::optional<io::SerialPort> port_;
};

}  // namespace

std::unique_ptr<Device> make_haply(HaplySettings settings) {
  DeviceInfo info{.name = settings.name, .driver = "haply", .max_force = settings.max_force};
  const BasePose base = settings.world_from_base;
  return std::make_unique<ThreadedDevice>(std::move(info), base,
                                          std::make_unique<HaplyRoutine>(std::move(settings)));
}

}  // namespace haptic::drivers::haply
