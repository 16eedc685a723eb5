#pragma once
// The records of an MCAP file from its start to wherever it ends, one at a time: what also works when the end
// is missing.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proto/recording/records.h"
#include "proto/recording/source.h"

namespace haptic::recording {

/// No longer record is read, whatever it says of itself.
inline constexpr std::uint64_t kLargestRecord = std::uint64_t{1} << 30;

struct Record {
  Opcode opcode{};
  std::uint64_t offset = 0;  // of its first byte
  std::string_view content;  // valid until the next one is asked for
};

class RecordStream {
 public:
  /// Throws FormatError if it does not begin like an MCAP file.
  explicit RecordStream(const Source& source);

  /// The next record at top level. Nothing after the Footer, and nothing when the rest is no whole record;
  /// damage() tells which. Throws IoError.
  std::optional<Record> next();

  /// Why it ended before a Footer with the magic after it; empty if it did not. To be asked at the end.
  const std::string& damage() const noexcept { return damage_; }

  /// Where the last whole record ends.
  std::uint64_t position() const noexcept { return position_; }

 private:
  std::optional<Record> stop(std::string why);

  const Source& source_;
  std::uint64_t position_;
  bool ended_ = false;
  std::string damage_;
  std::string buffer_;
};

/// The records within the decompressed records of a chunk. Throws FormatError where they are broken.
class ChunkRecords {
 public:
  explicit ChunkRecords(std::string_view records) noexcept : records_(records) {}
  std::optional<Record> next();

 private:
  std::string_view records_;
  std::size_t position_ = 0;
};

/// The decompressed records of a chunk, whose CRC is checked unless told otherwise. Throws FormatError.
enum class CheckCrc { kYes, kNo };
std::string records_of(const Chunk& chunk, CheckCrc check = CheckCrc::kYes);

}  // namespace haptic::recording
