#pragma once
// Values in words and units, for a person.

#include <cstdint>
#include <string>

#include "haptic/v1/control.pb.h"

namespace haptic::cli {

std::string describe(v1::FaultKind kind);
/// "left: over speed, 2.31 m/s where 2 m/s is allowed (tick 12345)"
std::string describe(const v1::Fault& fault);
std::string describe(v1::DevicePhase phase);
std::string describe(const v1::RealTime& real_time);
std::string describe(v1::Event::Kind kind);
/// "user ada (process 12), hapticctl: a heartbeat within 100 ms, the last one 21 ms ago"
std::string describe(const v1::DriveHolder& holder);

/// The four-letter states of the paper: Tet, Sur, Edg, Ver, Out.
const char* name_of(v1::ConstraintState state);

/// "box", "icosphere", ...
std::string name_of(const v1::Shape& shape);

/// "1 h 02 min", "12 s"
std::string duration(double seconds);
/// "740 ns", "12.3 us", "1.20 ms"
std::string nanoseconds(double ns);
/// "512 B", "1.5 MiB"
std::string bytes(std::uint64_t count);
/// "3 objects", "1 object"
std::string count_of(std::uint64_t count, const std::string& noun);

/// Metres as millimetres with a sign, "+12.34": what a hand can feel is near a hundredth.
std::string millimetres(double metres);

}  // namespace haptic::cli
