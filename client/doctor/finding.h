#pragma once
// What the doctor says of one thing.

#include <string>
#include <vector>

namespace haptic::doctor {

enum class Verdict {
  kOk,
  kNote,     // as it should be, or may be, and worth knowing
  kWarning,  // it works, and not as well as it could
  kBad       // it does not work
};

struct Finding {
  std::string about;  // "governor", "device hand"
  Verdict verdict = Verdict::kOk;
  std::string reason;     // one sentence without a full stop
  std::string command{};  // that mends it, or shows more; empty: there is none
};

using Findings = std::vector<Finding>;

/// "OK", "NOTE", "WARNING", "BAD"
const char* name_of(Verdict verdict) noexcept;

}  // namespace haptic::doctor
