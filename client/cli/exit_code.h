#pragma once
// What hapticctl tells the shell.

#include "client/lib/error.h"

namespace haptic::cli {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,
  kNothingToDo = 2,
  kNotFound = 3,
  kRefused = 4,
  kUnreachable = 5,
  kProtocolMismatch = 6,
  kFaultLatched = 7,
  kUsage = 64,
};

ExitCode exit_code(const client::Error& error) noexcept;

}  // namespace haptic::cli
