#include "proto/recording/recording.h"

#include <algorithm>

#include "proto/recording/error.h"

namespace haptic::recording {
namespace {

template <class Records>
auto find_name(const Records& records, std::string_view name) {
  return std::find_if(records.begin(), records.end(),
                      [name](const auto& record) { return record.name == name; });
}

bool may_be_in_summary(Opcode opcode) {
  switch (opcode) {
    case Opcode::kHeader:
    case Opcode::kFooter:
    case Opcode::kMessage:
    case Opcode::kChunk:
    case Opcode::kMessageIndex:
    case Opcode::kAttachment:
    case Opcode::kMetadata:
    case Opcode::kDataEnd:
      return false;
    default:
      return true;
  }
}

}  // namespace

Recording::Recording(const Source& source) : source_(source) {
  RecordStream stream(source);  // tells what is no MCAP file at all
  std::string broken;
  try {
    if (const auto first = stream.next(); first && first->opcode == Opcode::kHeader) {
      header_ = parse_header(first->content);
    }
    if (read_summary()) {
      return;
    }
  } catch (const FormatError& error) {
    broken = std::string("its summary cannot be used: ") + error.what();
  }
  forget();
  scan();
  if (damage_.empty()) {
    damage_ = broken;
  }
}

void Recording::forget() {
  schemas_.clear();
  channels_.clear();
  statistics_ = {};
  chunks_.clear();
  attachments_.clear();
  metadata_.clear();
}

// false: there is none, or the file has no end
bool Recording::read_summary() {
  if (source_.size() < kMagic.size() + kTail) {
    return false;
  }
  const std::uint64_t footer_offset = source_.size() - kTail;
  std::string bytes;
  source_.read(footer_offset, kTail, bytes);
  const Prefix prefix = parse_prefix(bytes);
  if (!bytes.ends_with(kMagic) || prefix.opcode != Opcode::kFooter || prefix.length != kFooterContent) {
    return false;
  }
  const std::string footer_bytes = bytes.substr(0, kFooterBytesInCrc);
  const Footer footer = parse_footer(std::string_view(bytes).substr(kRecordPrefix, kFooterContent));
  if (footer.summary_start == 0) {
    return false;
  }
  if (footer.summary_start < kMagic.size() || footer.summary_start > footer_offset ||
      footer_offset - footer.summary_start > kLargestRecord) {
    throw FormatError("it cannot begin at byte " + std::to_string(footer.summary_start));
  }
  source_.read(footer.summary_start, static_cast<std::size_t>(footer_offset - footer.summary_start), bytes);
  if (footer.summary_crc != 0 && footer.summary_crc != crc32(crc32(0, bytes), footer_bytes)) {
    throw FormatError("its bytes do not have the CRC that the Footer tells");
  }
  bool counted = false;
  ChunkRecords records(bytes);
  while (const auto record = records.next()) {
    counted = counted || record->opcode == Opcode::kStatistics;
    take_summary(*record);
  }
  std::set<std::uint64_t> offsets;
  for (const ChunkIndex& chunk : chunks_) {
    if (!offsets.insert(chunk.offset).second) {
      throw FormatError("it has the chunk at byte " + std::to_string(chunk.offset) + " twice");
    }
  }
  // without them it must be read through
  return counted && (statistics_.message_count == 0 || !chunks_.empty());
}

void Recording::take_summary(const Record& record) {
  switch (record.opcode) {
    case Opcode::kSchema:
      add(parse_schema(record.content));
      break;
    case Opcode::kChannel:
      add(parse_channel(record.content));
      break;
    case Opcode::kStatistics:
      statistics_ = parse_statistics(record.content);
      break;
    case Opcode::kChunkIndex:
      chunks_.push_back(parse_chunk_index(record.content));
      break;
    case Opcode::kAttachmentIndex:
      attachments_.push_back(parse_attachment_index(record.content));
      break;
    case Opcode::kMetadataIndex:
      metadata_.push_back(parse_metadata_index(record.content));
      break;
    default:
      if (!may_be_in_summary(record.opcode)) {
        throw FormatError("it has a record that belongs elsewhere");
      }
  }
}

void Recording::add(Schema schema) {
  const auto [known, is_new] = schemas_.try_emplace(schema.id, schema);
  if (!is_new && known->second != schema) {
    throw FormatError("schema " + std::to_string(schema.id) + " is told twice and differs");
  }
}

void Recording::add(Channel channel) {
  const auto [known, is_new] = channels_.try_emplace(channel.id, channel);
  if (!is_new && known->second != channel) {
    throw FormatError("channel " + std::to_string(channel.id) + " is told twice and differs");
  }
}

void Recording::scan() {
  RecordStream stream(source_);
  bool in_data = true;
  while (const auto record = stream.next()) {
    in_data = in_data && record->opcode != Opcode::kDataEnd && record->opcode != Opcode::kFooter;
    try {
      if (in_data) {
        scan_record(*record);
      }
    } catch (const FormatError& error) {
      if (damage_.empty()) {
        damage_ = "the record at byte " + std::to_string(record->offset) + " is broken: " + error.what();
      }
    }
  }
  if (!stream.damage().empty()) {
    damage_ = stream.damage();
  }
  if (damage_.empty() && lost_messages_ > 0) {
    damage_ = "it has messages of channels that it does not tell: " + std::to_string(lost_messages_);
  }
  statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
  statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
  statistics_.attachment_count = static_cast<std::uint32_t>(attachments_.size());
  statistics_.metadata_count = static_cast<std::uint32_t>(metadata_.size());
}

void Recording::scan_record(const Record& record) {
  const std::uint64_t length = kRecordPrefix + record.content.size();
  switch (record.opcode) {
    case Opcode::kSchema:
      add(parse_schema(record.content));
      break;
    case Opcode::kChannel:
      add(parse_channel(record.content));
      break;
    case Opcode::kChunk:
      scan_chunk(record);
      break;
    case Opcode::kMessage: {
      // read as a chunk of one
      ChunkIndex index;
      index.offset = record.offset;
      index.length = length;
      scan_message(parse_message(record.content), index);
      if (!index.message_index_offsets.empty()) {
        chunks_.push_back(std::move(index));
      }
      break;
    }
    case Opcode::kAttachment:
      attachments_.push_back(index_attachment(record.content, record.offset));
      break;
    case Opcode::kMetadata:
      metadata_.push_back({record.offset, length, parse_metadata(record.content).name});
      break;
    default:
      break;
  }
}

void Recording::scan_chunk(const Record& record) {
  const Chunk chunk = parse_chunk(record.content);
  ChunkIndex index;
  index.offset = record.offset;
  index.length = kRecordPrefix + record.content.size();
  index.compression = chunk.compression;
  index.compressed_size = chunk.records.size();
  index.uncompressed_size = chunk.uncompressed_size;
  const std::string bytes = records_of(chunk);
  std::vector<Message> messages;
  ChunkRecords records(bytes);
  while (const auto inner = records.next()) {
    if (inner->opcode == Opcode::kSchema) {
      add(parse_schema(inner->content));
    } else if (inner->opcode == Opcode::kChannel) {
      add(parse_channel(inner->content));
    } else if (inner->opcode == Opcode::kMessage) {
      messages.push_back(parse_message(inner->content));
    }
  }
  // only now: a chunk that is broken further on counts for nothing
  for (const Message& message : messages) {
    scan_message(message, index);
  }
  ++statistics_.chunk_count;
  chunks_.push_back(std::move(index));
}

void Recording::scan_message(const Message& message, ChunkIndex& index) {
  if (channels_.count(message.channel_id) == 0) {
    ++lost_messages_;
    return;
  }
  const bool first = index.message_index_offsets.empty();
  index.start_time = first ? message.log_time : std::min(index.start_time, message.log_time);
  index.end_time = std::max(index.end_time, message.log_time);
  index.message_index_offsets.emplace(message.channel_id, 0);
  statistics_.start_time =
      statistics_.message_count == 0 ? message.log_time : std::min(statistics_.start_time, message.log_time);
  statistics_.end_time = std::max(statistics_.end_time, message.log_time);
  ++statistics_.message_count;
  ++statistics_.channel_message_counts[message.channel_id];
}

std::string Recording::schema_name(const Channel& channel) const {
  const auto schema = schemas_.find(channel.schema_id);
  return schema == schemas_.end() ? std::string() : schema->second.name;
}

std::string Recording::content(Opcode opcode, std::uint64_t offset, std::uint64_t length) const {
  const std::string where = "the record at byte " + std::to_string(offset);
  if (length < kRecordPrefix || length > kLargestRecord) {
    throw FormatError(where + " cannot have " + std::to_string(length) + " bytes");
  }
  std::string bytes;
  source_.read(offset, static_cast<std::size_t>(length), bytes);
  const Prefix prefix = parse_prefix(bytes);
  if (prefix.opcode != opcode || prefix.length != length - kRecordPrefix) {
    throw FormatError(where + " is not the one that the summary tells of");
  }
  bytes.erase(0, kRecordPrefix);
  return bytes;
}

Attachment Recording::read(const AttachmentIndex& index) const {
  return parse_attachment(content(Opcode::kAttachment, index.offset, index.length));
}

Metadata Recording::read(const MetadataIndex& index) const {
  return parse_metadata(content(Opcode::kMetadata, index.offset, index.length));
}

std::optional<Metadata> Recording::find_metadata(std::string_view name) const {
  const auto found = find_name(metadata_, name);
  return found == metadata_.end() ? std::nullopt : std::optional(read(*found));
}

std::optional<Attachment> Recording::find_attachment(std::string_view name) const {
  const auto found = find_name(attachments_, name);
  return found == attachments_.end() ? std::nullopt : std::optional(read(*found));
}

}  // namespace haptic::recording
