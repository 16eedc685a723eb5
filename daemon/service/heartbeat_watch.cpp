#include "service/heartbeat_watch.h"

namespace haptic::service {
namespace {

constexpr std::int64_t kWindowNs = 200'000'000;  // 20 ticks at the slowest rate there is
// a desktop without real-time rights loses a tick now and then; one that loses more keeps no period
constexpr double kLeastShare = 0.9;
// so that two words may come late before the watchdog bites
constexpr std::int64_t kWordsPerLimit = 4;

}  // namespace

HeartbeatWatch::HeartbeatWatch(double rate_hz, std::optional<std::int64_t> watchdog_ns) noexcept
    : rate_hz_(rate_hz), watchdog_ns_(watchdog_ns) {}

HeartbeatWatch::Verdict HeartbeatWatch::look(std::int64_t now_ns, std::uint64_t heartbeat) noexcept {
  if (!proved_) return prove(now_ns, heartbeat);
  if (!watchdog_ns_ || now_ns - since_ns_ < *watchdog_ns_ / kWordsPerLimit || heartbeat == since_heartbeat_) {
    return Verdict::kNothing;
  }
  since_ns_ = now_ns;
  since_heartbeat_ = heartbeat;
  return Verdict::kAlive;
}

HeartbeatWatch::Verdict HeartbeatWatch::prove(std::int64_t now_ns, std::uint64_t heartbeat) noexcept {
  const std::int64_t span_ns = now_ns - since_ns_;
  if (begun_ && span_ns < kWindowNs) return Verdict::kNothing;
  if (begun_) {
    measured_hz_ = static_cast<double>(heartbeat - since_heartbeat_) * 1e9 / static_cast<double>(span_ns);
    proved_ = measured_hz_ >= kLeastShare * rate_hz_;
  }
  begun_ = true;
  since_ns_ = now_ns;
  since_heartbeat_ = heartbeat;
  return proved_ ? Verdict::kReady : Verdict::kNothing;
}

}  // namespace haptic::service
