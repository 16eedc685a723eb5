#include "proto/metrics/names.h"

#include <algorithm>
#include <cctype>

namespace haptic::metrics {

namespace {

std::string without(const std::string& prefix, const std::string& name) {
  std::string word = name.starts_with(prefix) ? name.substr(prefix.size()) : name;
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

}  // namespace

std::string word_of(v1::FaultKind kind) {
  if (!v1::FaultKind_IsValid(kind)) return "fault_" + std::to_string(static_cast<int>(kind));
  return without("FAULT_", v1::FaultKind_Name(kind));
}

std::string word_of(v1::DevicePhase phase) {
  const bool is_known = v1::DevicePhase_IsValid(phase) && phase != v1::DEVICE_PHASE_UNSPECIFIED;
  return is_known ? without("DEVICE_", v1::DevicePhase_Name(phase)) : "unknown";
}

}  // namespace haptic::metrics
