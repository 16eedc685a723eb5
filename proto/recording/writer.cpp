#include "proto/recording/writer.h"

#include <algorithm>
#include <utility>

#include "proto/recording/error.h"

namespace haptic::recording {
namespace {

// adds a group of summary records, and where it is
template <class Records>
void append_group(Opcode opcode, const Records& records, std::uint64_t start, std::string& out,
                  std::vector<SummaryOffset>& offsets) {
  if (records.empty()) {
    return;
  }
  const std::size_t before = out.size();
  for (const auto& record : records) {
    append(record, out);
  }
  offsets.push_back({opcode, start + before, out.size() - before});
}

template <class Record>
std::vector<Record> values(const std::map<std::uint16_t, Record>& map) {
  std::vector<Record> records;
  records.reserve(map.size());
  for (const auto& [id, record] : map) {
    records.push_back(record);
  }
  return records;
}

}  // namespace

Writer::Writer(Sink& sink, WriterOptions options) : sink_(sink), options_(std::move(options)) {
  buffer_ = kMagic;
  append(Header{"", options_.library}, buffer_);
  put(buffer_);
}

void Writer::add(const Schema& schema) {
  const auto known = schemas_.find(schema.id);
  if (known != schemas_.end()) {
    if (known->second != schema) {
      throw FormatError("schema " + std::to_string(schema.id) + " is told twice and differs");
    }
    return;
  }
  buffer_.clear();
  append(schema, buffer_);
  put(buffer_);
  schemas_.emplace(schema.id, schema);
  statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
}

void Writer::add(const Channel& channel) {
  const auto known = channels_.find(channel.id);
  if (known != channels_.end()) {
    if (known->second != channel) {
      throw FormatError("channel " + std::to_string(channel.id) + " is told twice and differs");
    }
    return;
  }
  if (channel.schema_id != 0 && schemas_.count(channel.schema_id) == 0) {
    throw FormatError("channel " + std::to_string(channel.id) + " has the schema " +
                      std::to_string(channel.schema_id) + ", which there is not");
  }
  buffer_.clear();
  append(channel, buffer_);
  put(buffer_);
  channels_.emplace(channel.id, channel);
  statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
}

void Writer::write(const Message& message) {
  if (!failure_.empty()) {
    throw IoError(failure_);
  }
  if (channels_.count(message.channel_id) == 0) {
    throw FormatError("a message is of channel " + std::to_string(message.channel_id) +
                      ", which there is not");
  }
  if (chunk_.messages > 0) {
    const std::uint64_t start = std::min(chunk_.start_time, message.log_time);
    const std::uint64_t end = std::max(chunk_.end_time, message.log_time);
    if (end - start >= options_.chunk_ns) {
      flush();
    }
  }
  MessageIndex& index = chunk_.index[message.channel_id];
  index.channel_id = message.channel_id;
  index.entries.emplace_back(message.log_time, chunk_.records.size());
  append(message, chunk_.records);
  chunk_.start_time = chunk_.messages == 0 ? message.log_time : std::min(chunk_.start_time, message.log_time);
  chunk_.end_time = std::max(chunk_.end_time, message.log_time);
  ++chunk_.messages;
  if (chunk_.records.size() >= options_.chunk_bytes) {
    flush();
  }
}

void Writer::add(const Attachment& attachment) {
  buffer_.clear();
  append(attachment, buffer_);
  AttachmentIndex index{size_,
                        buffer_.size(),
                        attachment.log_time,
                        attachment.create_time,
                        attachment.data.size(),
                        attachment.name,
                        attachment.media_type};
  put(buffer_);
  attachments_.push_back(std::move(index));
  ++statistics_.attachment_count;
}

void Writer::add(const Metadata& metadata) {
  buffer_.clear();
  append(metadata, buffer_);
  const MetadataIndex index{size_, buffer_.size(), metadata.name};
  put(buffer_);
  metadata_.push_back(index);
  ++statistics_.metadata_count;
}

void Writer::flush() {
  if (chunk_.messages == 0) {
    return;
  }
  const OpenChunk chunk = std::exchange(chunk_, {});
  const std::string_view compressed =
      options_.compress ? compressor_.compress(chunk.records) : std::string_view();
  ChunkIndex index;
  index.start_time = chunk.start_time;
  index.end_time = chunk.end_time;
  index.offset = size_;
  index.compression = compressed.empty() ? "" : "zstd";
  index.uncompressed_size = chunk.records.size();

  const std::string_view records = compressed.empty() ? std::string_view(chunk.records) : compressed;
  index.compressed_size = records.size();
  buffer_.clear();
  append(Chunk{chunk.start_time, chunk.end_time, chunk.records.size(), crc32(0, chunk.records),
               index.compression, records},
         buffer_);
  index.length = buffer_.size();
  for (const auto& [channel, messages] : chunk.index) {
    index.message_index_offsets.emplace(channel, size_ + buffer_.size());
    append(messages, buffer_);
  }
  index.message_index_length = buffer_.size() - index.length;
  put(buffer_);
  chunks_.push_back(std::move(index));
  count(chunk);
  sink_.sync();
}

void Writer::count(const OpenChunk& chunk) {
  statistics_.start_time =
      statistics_.message_count == 0 ? chunk.start_time : std::min(statistics_.start_time, chunk.start_time);
  statistics_.end_time = std::max(statistics_.end_time, chunk.end_time);
  statistics_.message_count += chunk.messages;
  ++statistics_.chunk_count;
  for (const auto& [channel, messages] : chunk.index) {
    statistics_.channel_message_counts[channel] += messages.entries.size();
  }
}

void Writer::close() {
  if (torn_) {
    throw IoError(failure_);
  }
  if (closed_) {
    return;
  }
  std::string lost;  // why the last chunk is
  try {
    flush();
  } catch (const IoError& error) {
    if (torn_) {
      throw;
    }
    lost = error.what();
  }
  buffer_.clear();
  append(DataEnd{crc_}, buffer_);
  buffer_ += summary(size_ + buffer_.size());
  buffer_ += kMagic;
  failure_.clear();  // what failed was cut off again: there may be room enough for this
  put(buffer_);
  closed_ = true;
  sink_.sync();
  if (!lost.empty()) {
    throw IoError(lost);
  }
}

std::string Writer::summary(std::uint64_t start) const {
  std::string out;
  std::vector<SummaryOffset> offsets;
  append_group(Opcode::kSchema, values(schemas_), start, out, offsets);
  append_group(Opcode::kChannel, values(channels_), start, out, offsets);
  append_group(Opcode::kStatistics, std::vector<Statistics>{statistics_}, start, out, offsets);
  append_group(Opcode::kMetadataIndex, metadata_, start, out, offsets);
  append_group(Opcode::kAttachmentIndex, attachments_, start, out, offsets);
  append_group(Opcode::kChunkIndex, chunks_, start, out, offsets);
  Footer footer{start, start + out.size(), 0};
  for (const SummaryOffset& offset : offsets) {
    append(offset, out);
  }
  std::string record;
  append(footer, record);
  footer.summary_crc = crc32(crc32(0, out), std::string_view(record).substr(0, kFooterBytesInCrc));
  append(footer, out);
  return out;
}

void Writer::put(std::string_view bytes) {
  if (!failure_.empty()) {
    throw IoError(failure_);
  }
  try {
    sink_.write(bytes);
  } catch (const IoError& error) {
    failure_ = error.what();
    try {
      sink_.truncate(size_);
    } catch (const IoError&) {
      torn_ = true;
    }
    throw;
  }
  size_ += bytes.size();
  crc_ = crc32(crc_, bytes);
}

}  // namespace haptic::recording
