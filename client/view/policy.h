#pragma once
// What a page may ask the daemon for. The daemon has the last word all the same: this keeps a browser from
// what its person's account might do. Pure.

#include <cstdint>
#include <optional>

#include "client/view/admission.h"
#include "haptic/v1/control.pb.h"

namespace haptic::gateway {

/// What a browser with these rights is told that it is, at the most.
v1::Role role_of(Rights rights, v1::Role of_gateway) noexcept;

/// The daemon's hello as a page with these rights sees it: its role, and no feature that it may not use.
v1::Hello hello_for(Rights rights, const v1::Hello& daemon);

/// Ticks for each frame so that no more than `frames_per_second` come.
std::uint32_t least_decimation(double ticks_per_second, double frames_per_second) noexcept;

/// Nothing: the request may go on, changed so that a subscription takes the newest of one frame in
/// `least_decimation` ticks at most. Otherwise why not, as the answer that the page gets.
std::optional<v1::Error> judge(v1::Request& request, Rights rights, std::uint32_t least_decimation);

}  // namespace haptic::gateway
