#pragma once
// What can go wrong with a recording. what() is one line for a person.

#include <stdexcept>

namespace haptic::recording {

/// The bytes are no MCAP file, or break its rules; what() says where.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The operating system refuses to open, read or write; what() names the file and says why.
class IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace haptic::recording
