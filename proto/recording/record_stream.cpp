#include "proto/recording/record_stream.h"

#include <utility>

#include "proto/recording/compression.h"
#include "proto/recording/error.h"

namespace haptic::recording {

RecordStream::RecordStream(const Source& source) : source_(source), position_(kMagic.size()) {
  if (source.size() >= kMagic.size()) {
    source.read(0, kMagic.size(), buffer_);
  }
  if (buffer_ != kMagic) {
    throw FormatError("is no MCAP file: it does not begin as one");
  }
}

std::optional<Record> RecordStream::next() {
  if (ended_) {
    return std::nullopt;
  }
  const std::uint64_t left = source_.size() - position_;
  if (left == 0) {
    return stop("it ends at byte " + std::to_string(position_) + ", without a Footer");
  }
  if (left < kRecordPrefix) {
    return stop("it is cut off at byte " + std::to_string(source_.size()) + ", within a record");
  }
  source_.read(position_, kRecordPrefix, buffer_);
  const Prefix prefix = parse_prefix(buffer_);
  const std::string where = "the record at byte " + std::to_string(position_);
  if (static_cast<std::uint8_t>(prefix.opcode) == 0) {
    return stop(where + " is none");
  }
  if (prefix.length > left - kRecordPrefix) {
    return stop(where + " is cut off: it has " + std::to_string(left - kRecordPrefix) + " of " +
                std::to_string(prefix.length) + " bytes");
  }
  if (prefix.length > kLargestRecord) {
    return stop(where + " is larger than the " + std::to_string(kLargestRecord) +
                " bytes that are permitted");
  }
  Record record{prefix.opcode, position_, {}};
  source_.read(position_ + kRecordPrefix, static_cast<std::size_t>(prefix.length), buffer_);
  record.content = buffer_;
  position_ += kRecordPrefix + prefix.length;
  if (prefix.opcode == Opcode::kFooter) {
    ended_ = true;
    std::string magic;
    if (source_.size() - position_ >= kMagic.size()) {
      source_.read(position_, kMagic.size(), magic);
    }
    if (magic != kMagic) {
      damage_ = "it is cut off at byte " + std::to_string(source_.size()) + ", after its Footer";
    } else if (source_.size() - position_ != kMagic.size()) {
      damage_ = "it goes on after its end at byte " + std::to_string(position_ + kMagic.size());
    }
  }
  return record;
}

std::optional<Record> RecordStream::stop(std::string why) {
  ended_ = true;
  damage_ = std::move(why);
  return std::nullopt;
}

std::optional<Record> ChunkRecords::next() {
  const std::string_view left = records_.substr(position_);
  if (left.empty()) {
    return std::nullopt;
  }
  const Prefix prefix = parse_prefix(left);
  if (static_cast<std::uint8_t>(prefix.opcode) == 0) {
    throw FormatError("a record in a chunk is none");
  }
  if (prefix.length > left.size() - kRecordPrefix) {
    throw FormatError("a record in a chunk goes on beyond its end");
  }
  const Record record{prefix.opcode, position_,
                      left.substr(kRecordPrefix, static_cast<std::size_t>(prefix.length))};
  position_ += kRecordPrefix + record.content.size();
  return record;
}

std::string records_of(const Chunk& chunk, CheckCrc check) {
  std::string records = decompress(chunk.compression, chunk.records, chunk.uncompressed_size);
  if (check == CheckCrc::kYes && chunk.uncompressed_crc != 0 && crc32(0, records) != chunk.uncompressed_crc) {
    throw FormatError("the bytes of a chunk do not have the CRC that it tells");
  }
  return records;
}

}  // namespace haptic::recording
