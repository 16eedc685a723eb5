#include "proto/recording/records.h"

#include <zlib.h>

#include "proto/recording/error.h"

namespace haptic::recording {
namespace {

template <class Unsigned>
void put(Unsigned value, std::string& out) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    out.push_back(static_cast<char>((std::uint64_t{value} >> (8 * i)) & 0xff));
  }
}

void put_string(std::string_view text, std::string& out) {
  put(static_cast<std::uint32_t>(text.size()), out);
  out.append(text);
}

// overwrites the eight or four bytes that were put before the length was known
template <class Unsigned>
void mend(std::size_t at, Unsigned value, std::string& out) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    out[at + i] = static_cast<char>((std::uint64_t{value} >> (8 * i)) & 0xff);
  }
}

// a record whose length is filled in when this ends
class Open {
 public:
  Open(Opcode opcode, std::string& out) : out_(out) {
    out_.push_back(static_cast<char>(opcode));
    put(std::uint64_t{0}, out_);
    start_ = out_.size();
  }
  ~Open() { mend(start_ - sizeof(std::uint64_t), std::uint64_t{out_.size() - start_}, out_); }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;

 private:
  std::string& out_;
  std::size_t start_;
};

// arrays and maps: their length in bytes, then what `fill` puts
template <class Fill>
void put_sized(std::string& out, Fill fill) {
  const std::size_t start = out.size();
  put(std::uint32_t{0}, out);
  fill();
  mend(start, static_cast<std::uint32_t>(out.size() - start - sizeof(std::uint32_t)), out);
}

void put_map(const StringMap& map, std::string& out) {
  put_sized(out, [&] {
    for (const auto& [key, value] : map) {
      put_string(key, out);
      put_string(value, out);
    }
  });
}

void put_map(const std::map<std::uint16_t, std::uint64_t>& map, std::string& out) {
  put_sized(out, [&] {
    for (const auto& [key, value] : map) {
      put(key, out);
      put(value, out);
    }
  });
}

// reads the content of a record from its start; never beyond its end
class Cursor {
 public:
  Cursor(std::string_view content, const char* record) : rest_(content), record_(record) {}

  std::string_view take(std::uint64_t size) {
    if (size > rest_.size()) {
      throw FormatError(std::string(record_) + " record: " + std::to_string(size) + " bytes expected, " +
                        std::to_string(rest_.size()) + " left");
    }
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(taken.size());
    return taken;
  }

  template <class Unsigned>
  Unsigned number() {
    const std::string_view bytes = take(sizeof(Unsigned));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    }
    return static_cast<Unsigned>(value);
  }

  std::uint16_t u16() { return number<std::uint16_t>(); }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  std::string_view view() { return take(u32()); }
  std::string string() { return std::string(view()); }
  std::string_view rest() { return take(rest_.size()); }
  bool at_end() const { return rest_.empty(); }

  /// An array or a map, to be read by a cursor of its own.
  Cursor sized() { return {take(u32()), record_}; }

  StringMap string_map() {
    StringMap map;
    for (Cursor pairs = sized(); !pairs.at_end();) {
      std::string key = pairs.string();
      if (!map.emplace(key, pairs.string()).second) {
        fail("key \"" + key + "\" occurs twice");
      }
    }
    return map;
  }

  std::map<std::uint16_t, std::uint64_t> number_map() {
    std::map<std::uint16_t, std::uint64_t> map;
    for (Cursor pairs = sized(); !pairs.at_end();) {
      const std::uint16_t key = pairs.u16();
      if (!map.emplace(key, pairs.u64()).second) {
        fail("channel " + std::to_string(key) + " occurs twice");
      }
    }
    return map;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(std::string(record_) + " record: " + what);
  }

 private:
  std::string_view rest_;
  const char* record_;
};

AttachmentIndex read_attachment_head(Cursor& cursor) {
  AttachmentIndex head;
  head.log_time = cursor.u64();
  head.create_time = cursor.u64();
  head.name = cursor.string();
  head.media_type = cursor.string();
  head.data_size = cursor.u64();
  return head;
}

}  // namespace

void append(const Header& record, std::string& out) {
  const Open open(Opcode::kHeader, out);
  put_string(record.profile, out);
  put_string(record.library, out);
}

void append(const Footer& record, std::string& out) {
  const Open open(Opcode::kFooter, out);
  put(record.summary_start, out);
  put(record.summary_offset_start, out);
  put(record.summary_crc, out);
}

void append(const Schema& record, std::string& out) {
  const Open open(Opcode::kSchema, out);
  put(record.id, out);
  put_string(record.name, out);
  put_string(record.encoding, out);
  put_string(record.data, out);
}

void append(const Channel& record, std::string& out) {
  const Open open(Opcode::kChannel, out);
  put(record.id, out);
  put(record.schema_id, out);
  put_string(record.topic, out);
  put_string(record.message_encoding, out);
  put_map(record.metadata, out);
}

void append(const Message& record, std::string& out) {
  const Open open(Opcode::kMessage, out);
  put(record.channel_id, out);
  put(record.sequence, out);
  put(record.log_time, out);
  put(record.publish_time, out);
  out.append(record.data);
}

void append(const Chunk& record, std::string& out) {
  const Open open(Opcode::kChunk, out);
  put(record.start_time, out);
  put(record.end_time, out);
  put(record.uncompressed_size, out);
  put(record.uncompressed_crc, out);
  put_string(record.compression, out);
  put(std::uint64_t{record.records.size()}, out);
  out.append(record.records);
}

void append(const MessageIndex& record, std::string& out) {
  const Open open(Opcode::kMessageIndex, out);
  put(record.channel_id, out);
  put_sized(out, [&] {
    for (const auto& [log_time, offset] : record.entries) {
      put(log_time, out);
      put(offset, out);
    }
  });
}

void append(const ChunkIndex& record, std::string& out) {
  const Open open(Opcode::kChunkIndex, out);
  put(record.start_time, out);
  put(record.end_time, out);
  put(record.offset, out);
  put(record.length, out);
  put_map(record.message_index_offsets, out);
  put(record.message_index_length, out);
  put_string(record.compression, out);
  put(record.compressed_size, out);
  put(record.uncompressed_size, out);
}

void append(const Attachment& record, std::string& out) {
  const Open open(Opcode::kAttachment, out);
  const std::size_t start = out.size();
  put(record.log_time, out);
  put(record.create_time, out);
  put_string(record.name, out);
  put_string(record.media_type, out);
  put(std::uint64_t{record.data.size()}, out);
  out.append(record.data);
  put(crc32(0, std::string_view(out).substr(start)), out);
}

void append(const AttachmentIndex& record, std::string& out) {
  const Open open(Opcode::kAttachmentIndex, out);
  put(record.offset, out);
  put(record.length, out);
  put(record.log_time, out);
  put(record.create_time, out);
  put(record.data_size, out);
  put_string(record.name, out);
  put_string(record.media_type, out);
}

void append(const Statistics& record, std::string& out) {
  const Open open(Opcode::kStatistics, out);
  put(record.message_count, out);
  put(record.schema_count, out);
  put(record.channel_count, out);
  put(record.attachment_count, out);
  put(record.metadata_count, out);
  put(record.chunk_count, out);
  put(record.start_time, out);
  put(record.end_time, out);
  put_map(record.channel_message_counts, out);
}

void append(const Metadata& record, std::string& out) {
  const Open open(Opcode::kMetadata, out);
  put_string(record.name, out);
  put_map(record.metadata, out);
}

void append(const MetadataIndex& record, std::string& out) {
  const Open open(Opcode::kMetadataIndex, out);
  put(record.offset, out);
  put(record.length, out);
  put_string(record.name, out);
}

void append(const SummaryOffset& record, std::string& out) {
  const Open open(Opcode::kSummaryOffset, out);
  put(static_cast<std::uint8_t>(record.group), out);
  put(record.start, out);
  put(record.length, out);
}

void append(const DataEnd& record, std::string& out) {
  const Open open(Opcode::kDataEnd, out);
  put(record.data_section_crc, out);
}

Header parse_header(std::string_view content) {
  Cursor cursor(content, "Header");
  Header record;
  record.profile = cursor.string();
  record.library = cursor.string();
  return record;
}

Footer parse_footer(std::string_view content) {
  Cursor cursor(content, "Footer");
  Footer record;
  record.summary_start = cursor.u64();
  record.summary_offset_start = cursor.u64();
  record.summary_crc = cursor.u32();
  if (!cursor.at_end()) {
    cursor.fail("is longer than it ever may be");
  }
  return record;
}

Schema parse_schema(std::string_view content) {
  Cursor cursor(content, "Schema");
  Schema record;
  record.id = cursor.u16();
  record.name = cursor.string();
  record.encoding = cursor.string();
  record.data = cursor.string();
  if (record.id == 0) {
    cursor.fail("has the id 0, which means none");
  }
  return record;
}

Channel parse_channel(std::string_view content) {
  Cursor cursor(content, "Channel");
  Channel record;
  record.id = cursor.u16();
  record.schema_id = cursor.u16();
  record.topic = cursor.string();
  record.message_encoding = cursor.string();
  record.metadata = cursor.string_map();
  return record;
}

Message parse_message(std::string_view content) {
  Cursor cursor(content, "Message");
  Message record;
  record.channel_id = cursor.u16();
  record.sequence = cursor.u32();
  record.log_time = cursor.u64();
  record.publish_time = cursor.u64();
  record.data = cursor.rest();
  return record;
}

Chunk parse_chunk(std::string_view content) {
  Cursor cursor(content, "Chunk");
  Chunk record;
  record.start_time = cursor.u64();
  record.end_time = cursor.u64();
  record.uncompressed_size = cursor.u64();
  record.uncompressed_crc = cursor.u32();
  record.compression = cursor.string();
  record.records = cursor.take(cursor.u64());
  return record;
}

MessageIndex parse_message_index(std::string_view content) {
  Cursor cursor(content, "MessageIndex");
  MessageIndex record;
  record.channel_id = cursor.u16();
  for (Cursor entries = cursor.sized(); !entries.at_end();) {
    const std::uint64_t log_time = entries.u64();
    record.entries.emplace_back(log_time, entries.u64());
  }
  return record;
}

ChunkIndex parse_chunk_index(std::string_view content) {
  Cursor cursor(content, "ChunkIndex");
  ChunkIndex record;
  record.start_time = cursor.u64();
  record.end_time = cursor.u64();
  record.offset = cursor.u64();
  record.length = cursor.u64();
  record.message_index_offsets = cursor.number_map();
  record.message_index_length = cursor.u64();
  record.compression = cursor.string();
  record.compressed_size = cursor.u64();
  record.uncompressed_size = cursor.u64();
  return record;
}

Attachment parse_attachment(std::string_view content) {
  Cursor cursor(content, "Attachment");
  AttachmentIndex head = read_attachment_head(cursor);
  const std::string_view data = cursor.take(head.data_size);
  const auto covered = static_cast<std::size_t>(data.data() + data.size() - content.data());
  const std::uint32_t crc = cursor.u32();
  if (crc != 0 && crc != crc32(0, content.substr(0, covered))) {
    cursor.fail("its bytes do not have the CRC that it tells");
  }
  return {head.log_time, head.create_time, std::move(head.name), std::move(head.media_type),
          std::string(data)};
}

AttachmentIndex index_attachment(std::string_view content, std::uint64_t offset) {
  Cursor cursor(content, "Attachment");
  AttachmentIndex index = read_attachment_head(cursor);
  index.offset = offset;
  index.length = kRecordPrefix + content.size();
  return index;
}

AttachmentIndex parse_attachment_index(std::string_view content) {
  Cursor cursor(content, "AttachmentIndex");
  AttachmentIndex record;
  record.offset = cursor.u64();
  record.length = cursor.u64();
  record.log_time = cursor.u64();
  record.create_time = cursor.u64();
  record.data_size = cursor.u64();
  record.name = cursor.string();
  record.media_type = cursor.string();
  return record;
}

Statistics parse_statistics(std::string_view content) {
  Cursor cursor(content, "Statistics");
  Statistics record;
  record.message_count = cursor.u64();
  record.schema_count = cursor.u16();
  record.channel_count = cursor.u32();
  record.attachment_count = cursor.u32();
  record.metadata_count = cursor.u32();
  record.chunk_count = cursor.u32();
  record.start_time = cursor.u64();
  record.end_time = cursor.u64();
  record.channel_message_counts = cursor.number_map();
  return record;
}

Metadata parse_metadata(std::string_view content) {
  Cursor cursor(content, "Metadata");
  Metadata record;
  record.name = cursor.string();
  record.metadata = cursor.string_map();
  return record;
}

MetadataIndex parse_metadata_index(std::string_view content) {
  Cursor cursor(content, "MetadataIndex");
  MetadataIndex record;
  record.offset = cursor.u64();
  record.length = cursor.u64();
  record.name = cursor.string();
  return record;
}

DataEnd parse_data_end(std::string_view content) {
  Cursor cursor(content, "DataEnd");
  return {cursor.u32()};
}

Prefix parse_prefix(std::string_view bytes) {
  Cursor cursor(bytes, "a");
  const auto opcode = static_cast<Opcode>(cursor.number<std::uint8_t>());
  return {opcode, cursor.u64()};
}

std::uint32_t crc32(std::uint32_t crc, std::string_view bytes) noexcept {
  return static_cast<std::uint32_t>(
      ::crc32_z(crc, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace haptic::recording
