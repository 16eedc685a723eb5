#include "client/cli/exit_code.h"

namespace haptic::cli {

ExitCode exit_code(const client::Error& error) noexcept {
  if (dynamic_cast<const client::Unreachable*>(&error) != nullptr) {
    return kUnreachable;
  }
  switch (error.wire().code()) {
    case v1::Error::NOTHING_TO_DO:
      return kNothingToDo;
    case v1::Error::NOT_FOUND:
      return kNotFound;
    case v1::Error::REFUSED:
      return kRefused;
    case v1::Error::MISMATCH:
      return kProtocolMismatch;
    case v1::Error::FAULT_LATCHED:
      return kFaultLatched;
    default:
      return kFailed;
  }
}

}  // namespace haptic::cli
