#pragma once
// What can go wrong for a client, one type for each thing that a program may want to do about it. Every error
// carries what the daemon said, or what it would have said.

#include <stdexcept>
#include <string>

#include "haptic/v1/control.pb.h"

namespace haptic::client {

/// Base of all errors of this library; as itself, a request that failed (FAILED). what() is one line for a
/// person: the place in a file if there is one, the field, the message.
class Error : public std::runtime_error {
 public:
  explicit Error(v1::Error wire);
  const v1::Error& wire() const noexcept { return wire_; }

 private:
  v1::Error wire_;
};

/// No daemon there, or it went away, or it does not answer.
class Unreachable : public Error {
 public:
  explicit Unreachable(const std::string& message);
};

class ProtocolMismatch : public Error {
  using Error::Error;
};
class Refused : public Error {  // the role does not allow it
  using Error::Error;
};
class FaultLatched : public Error {
  using Error::Error;
};
class NotFound : public Error {
  using Error::Error;
};
class NothingToDo : public Error {
  using Error::Error;
};
class Invalid : public Error {
  using Error::Error;
};
class Unsupported : public Error {
  using Error::Error;
};
class Busy : public Error {
  using Error::Error;
};

/// Throws the type that belongs to the error's code.
[[noreturn]] void throw_error(const v1::Error& error);

}  // namespace haptic::client
