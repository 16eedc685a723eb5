#include "client/latency/latency.h"

#include <algorithm>
#include <string>

#include "rt/cpu_latency.h"
#include "rt/tick_clock.h"

namespace haptic::latency {

void Latenesses::record(std::uint64_t nanoseconds) noexcept {
  histogram_.record(nanoseconds);
  min_ns_ = std::min(min_ns_, nanoseconds);
  const auto end = std::lower_bound(kBinEnds.begin(), kBinEnds.end(), nanoseconds);
  ++bins_[static_cast<std::size_t>(end - kBinEnds.begin())];
}

Measured measure(const Settings& settings, const std::function<bool()>& stop) {
  Measured measured;
  rt::CpuLatency awake;
  const std::string refused = settings.awake ? awake.hold() : "";
  measured.is_awake = awake.is_held();
  const auto periods =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(settings.duration.count() * settings.rate_hz));
  rt::RealtimeThread thread(settings.thread, [&]() noexcept {
    const std::int64_t start = rt::monotonic_ns();
    rt::TickClock clock(settings.rate_hz);
    for (std::uint64_t tick = 0; tick + 1 < periods && !stop();) {
      const rt::Wakeup wakeup = clock.wait();
      tick = wakeup.tick;
      measured.times.record(wakeup.lateness_ns);
      measured.missed += wakeup.missed;
    }
    measured.seconds = static_cast<double>(rt::monotonic_ns() - start) * 1e-9;
  });
  thread.join();
  measured.rights = thread.report();
  if (!refused.empty()) measured.rights.warnings.push_back(refused);
  return measured;
}

}  // namespace haptic::latency
