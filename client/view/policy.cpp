#include "client/view/policy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptic::gateway {
namespace {

enum class Need { kObserve, kDrive, kNever };

Need need_of(const v1::Request& request) noexcept {
  switch (request.call_case()) {
    case v1::Request::kGetStatus:
    case v1::Request::kListDevices:
    case v1::Request::kGetScene:
    case v1::Request::kSubscribe:
    case v1::Request::kUnsubscribe:
    case v1::Request::kListFaults:
      return Need::kObserve;
    case v1::Request::kGetStats:  // the counters are everybody's
      return request.get_stats().reset() ? Need::kDrive : Need::kObserve;
    case v1::Request::kArm:
    case v1::Request::kDisarm:
    case v1::Request::kMoveDevice:
    case v1::Request::kEmergencyStop:
    case v1::Request::kClearFault:
    case v1::Request::kPause:
    case v1::Request::kResume:
    case v1::Request::kStep:
    case v1::Request::kResetScene:
    case v1::Request::kAcquireDrive:
    case v1::Request::kReleaseDrive:
    case v1::Request::kHeartbeat:
      return Need::kDrive;
    default:
      return Need::kNever;
  }
}

v1::Error refusal(const char* message, const char* field = "") {
  v1::Error error;
  error.set_code(v1::Error::REFUSED);
  error.set_message(message);
  error.set_field(field);
  return error;
}

}  // namespace

v1::Role role_of(Rights rights, v1::Role of_gateway) noexcept {
  return rights == Rights::kDrive ? of_gateway : std::min(of_gateway, v1::OBSERVE);
}

v1::Hello hello_for(Rights rights, const v1::Hello& daemon) {
  v1::Hello hello = daemon;
  hello.set_role(role_of(rights, daemon.role()));
  if (hello.role() < v1::DRIVE) {
    auto& features = *hello.mutable_feature();
    features.erase(std::remove(features.begin(), features.end(), "device.move"), features.end());
  }
  return hello;
}

std::uint32_t least_decimation(double ticks_per_second, double frames_per_second) noexcept {
  const double ticks = std::ceil(ticks_per_second / frames_per_second);
  // a daemon may tell anything
  if (!(ticks > 1.0)) {
    return 1;
  }
  return ticks < 1e6 ? static_cast<std::uint32_t>(ticks) : 1'000'000U;
}

std::optional<v1::Error> judge(v1::Request& request, Rights rights, std::uint32_t least_decimation) {
  switch (need_of(request)) {
    case Need::kNever:
      return refusal("haptic-view passes no such request on");
    case Need::kDrive:
      if (rights != Rights::kDrive) {
        return refusal("this page may only observe; open it with the token of a driver");
      }
      break;
    case Need::kObserve:
      break;
  }
  if (request.has_subscribe()) {
    v1::Subscribe& wish = *request.mutable_subscribe();
    if (std::find(wish.topic().begin(), wish.topic().end(), v1::INPUTS) != wish.topic().end()) {
      return refusal("inputs are for replay, and a page gets none", "topic");
    }
    wish.set_delivery(v1::LATEST);
    wish.set_decimation(std::max(wish.decimation(), least_decimation));
  }
  return std::nullopt;
}

}  // namespace haptic::gateway
