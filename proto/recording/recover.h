#pragma once
// Makes a whole file of one that was cut off or is broken in places.

#include <cstdint>
#include <string>

#include "proto/recording/source.h"
#include "proto/recording/writer.h"

namespace haptic::recording {

struct Recovered {
  std::uint64_t messages = 0;
  std::uint64_t attachments = 0;
  std::uint64_t chunks = 0;         // that were read
  std::uint64_t lost_chunks = 0;    // whose bytes are broken
  std::uint64_t lost_messages = 0;  // of channels that nothing tells of, as far as they can be counted
  std::uint64_t lost_records = 0;   // others that are broken
  std::uint64_t bytes_beyond = 0;   // of the source after its last whole record
  std::string damage;               // empty: the source was whole, and nothing is lost

  bool lossless() const noexcept {
    return lost_chunks == 0 && lost_messages == 0 && lost_records == 0 && bytes_beyond == 0;
  }
};

/// The Header.library of a file, as far as it has one.
std::string library_of(const Source& source);

/// Copies what can be read from `source` to `writer`, in the order of the file, and closes it. Indexes,
/// statistics and CRCs are made anew. A chunk with a wrong CRC is kept if its records can be read, and told
/// as damage. Throws FormatError if the source is no MCAP file at all, and IoError.
Recovered recover(const Source& source, Writer& writer);

}  // namespace haptic::recording
