#pragma once
// The records of an MCAP file as plain data, and their bytes. Source: the MCAP specification, version 0.
//
//     file:     magic | Header | data section | DataEnd | summary | summary offsets | Footer | magic
//     record:   opcode u8 | length of content u64 | content
//
// Numbers are little-endian without padding. Times are nanoseconds; ours are those of CLOCK_REALTIME. Offsets
// count from the start of the file unless said otherwise.
//
// append() adds a whole record; parse_...() reads a content, ignores bytes after the fields it knows, as the
// specification asks, and throws FormatError if it is too short. Lengths in it are checked against what is
// there before anything is allocated.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haptic::recording {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t kRecordPrefix = 9;  // opcode and length
inline constexpr std::size_t kFooterContent = 20;
inline constexpr std::size_t kTail = kRecordPrefix + kFooterContent + kMagic.size();  // Footer and magic

/// From 0x80 on records are private to whoever wrote them; those and unknown ones are skipped.
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

using StringMap = std::map<std::string, std::string>;

struct Header {
  std::string profile;
  std::string library;
};

struct Footer {
  std::uint64_t summary_start = 0;         // 0: there is no summary
  std::uint64_t summary_offset_start = 0;  // 0: none
  std::uint32_t summary_crc = 0;           // see kFooterBytesInCrc; 0: not computed, as for every CRC here
};

struct Schema {
  std::uint16_t id = 0;  // not 0
  std::string name;      // e.g. "haptic.v1.Frame"
  std::string encoding;  // "protobuf"
  std::string data;      // then a google.protobuf.FileDescriptorSet
  bool operator==(const Schema&) const = default;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  // 0: none
  std::string topic;
  std::string message_encoding;
  StringMap metadata;
  bool operator==(const Channel&) const = default;
};

/// A view: `data` belongs to whoever gave it.
struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  std::string_view data;
};

/// A view: `records` are Schema, Channel and Message records, compressed as `compression` says.
struct Chunk {
  std::uint64_t start_time = 0;  // least and greatest log_time inside
  std::uint64_t end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;
  std::string compression;  // "", "zstd", "lz4"
  std::string_view records;
};

struct MessageIndex {
  std::uint16_t channel_id = 0;
  // log_time, and offset of the Message record within the uncompressed records of its chunk
  std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;
};

struct ChunkIndex {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;                                      // of the Chunk record with its prefix
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;  // by channel; 0: not known
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;  // of Chunk.records
  std::uint64_t uncompressed_size = 0;
};

struct Attachment {
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;  // 0: unknown
  std::string name;
  std::string media_type;
  std::string data;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint64_t start_time = 0;  // least and greatest log_time; 0 without messages
  std::uint64_t end_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

struct Metadata {
  std::string name;
  StringMap metadata;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

struct SummaryOffset {
  Opcode group{};
  std::uint64_t start = 0;
  std::uint64_t length = 0;
};

struct DataEnd {
  std::uint32_t data_section_crc = 0;  // of every byte before this record
};

void append(const Header& record, std::string& out);
void append(const Footer& record, std::string& out);
void append(const Schema& record, std::string& out);
void append(const Channel& record, std::string& out);
void append(const Message& record, std::string& out);
void append(const Chunk& record, std::string& out);
void append(const MessageIndex& record, std::string& out);
void append(const ChunkIndex& record, std::string& out);
/// Its CRC is computed here.
void append(const Attachment& record, std::string& out);
void append(const AttachmentIndex& record, std::string& out);
void append(const Statistics& record, std::string& out);
void append(const Metadata& record, std::string& out);
void append(const MetadataIndex& record, std::string& out);
void append(const SummaryOffset& record, std::string& out);
void append(const DataEnd& record, std::string& out);

Header parse_header(std::string_view content);
Footer parse_footer(std::string_view content);
Schema parse_schema(std::string_view content);
Channel parse_channel(std::string_view content);
Message parse_message(std::string_view content);
Chunk parse_chunk(std::string_view content);
MessageIndex parse_message_index(std::string_view content);
ChunkIndex parse_chunk_index(std::string_view content);
/// Throws FormatError on a wrong CRC, too.
Attachment parse_attachment(std::string_view content);
/// All but the data, of an Attachment record at `offset`; its CRC is not checked.
AttachmentIndex index_attachment(std::string_view content, std::uint64_t offset);
AttachmentIndex parse_attachment_index(std::string_view content);
Statistics parse_statistics(std::string_view content);
Metadata parse_metadata(std::string_view content);
MetadataIndex parse_metadata_index(std::string_view content);
DataEnd parse_data_end(std::string_view content);

/// Of a record's prefix, which has kRecordPrefix bytes.
struct Prefix {
  Opcode opcode{};
  std::uint64_t length = 0;  // of the content
};
Prefix parse_prefix(std::string_view bytes);

/// How many bytes of a Footer record the summary's CRC covers, beside all of the summary before it.
inline constexpr std::size_t kFooterBytesInCrc = kRecordPrefix + 16;

/// CRC-32 as zlib has it, of more bytes after those of `crc`; 0 of none.
std::uint32_t crc32(std::uint32_t crc, std::string_view bytes) noexcept;

}  // namespace haptic::recording
