#include "client/lib/error.h"

#include <utility>

namespace haptic::client {
namespace {

std::string in_one_line(const v1::Error& error) {
  std::string line;
  if (!error.file().empty()) {
    line += error.file() + ":";
    if (error.line() > 0) {
      line += std::to_string(error.line()) + ":";
      if (error.column() > 0) {
        line += std::to_string(error.column()) + ":";
      }
    }
    line += " ";
  }
  if (!error.field().empty() && error.message().find(error.field()) == std::string::npos) {
    line += error.field() + ": ";
  }
  return line + error.message();
}

v1::Error failed(const std::string& message) {
  v1::Error error;
  error.set_code(v1::Error::FAILED);
  error.set_message(message);
  return error;
}

}  // namespace

Error::Error(v1::Error wire) : std::runtime_error(in_one_line(wire)), wire_(std::move(wire)) {}

Unreachable::Unreachable(const std::string& message) : Error(failed(message)) {}

void throw_error(const v1::Error& error) {
  switch (error.code()) {
    case v1::Error::NOTHING_TO_DO:
      throw NothingToDo(error);
    case v1::Error::NOT_FOUND:
      throw NotFound(error);
    case v1::Error::REFUSED:
      throw Refused(error);
    case v1::Error::FAULT_LATCHED:
      throw FaultLatched(error);
    case v1::Error::INVALID:
      throw Invalid(error);
    case v1::Error::UNSUPPORTED:
      throw Unsupported(error);
    case v1::Error::MISMATCH:
      throw ProtocolMismatch(error);
    case v1::Error::BUSY:
      throw Busy(error);
    default:
      throw Error(error);
  }
}

}  // namespace haptic::client
