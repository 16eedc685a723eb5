#include <google/protobuf/message.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "proto/recording/compression.h"
#include "proto/recording/error.h"
#include "proto/recording/recording.h"

namespace haptic::recording {
namespace {

// of chunks that overlap in time and so are kept at once
constexpr std::uint64_t kMostHeld = 2 * kLargestChunk;

bool ends_before(const Query& query, std::uint64_t time) {
  return query.to != std::numeric_limits<std::uint64_t>::max() && query.to <= time;
}

}  // namespace

Messages::Loaded::Loaded(std::string bytes, std::shared_ptr<std::uint64_t> held_bytes)
    : records(std::move(bytes)), held(std::move(held_bytes)) {
  *held += records.size();
}

Messages::Loaded::~Loaded() { *held -= records.size(); }

bool Messages::Waiting::operator>(const Waiting& other) const noexcept {
  // within a chunk, views into it are in the order of the file
  return std::tuple(log_time, chunk_offset, message.data.data()) >
         std::tuple(other.log_time, other.chunk_offset, other.message.data.data());
}

Messages::Messages(const Recording& recording, Query query)
    : recording_(&recording), query_(std::move(query)) {
  for (const auto& [id, channel] : recording.channels()) {
    if (query_.topics.empty() ||
        std::find(query_.topics.begin(), query_.topics.end(), channel.topic) != query_.topics.end()) {
      channels_.insert(id);
    }
  }
  for (const ChunkIndex& chunk : recording.chunks()) {
    if (wants(chunk)) {
      chunks_.push_back(&chunk);
    }
  }
  std::stable_sort(chunks_.begin(), chunks_.end(),
                   [](const auto* a, const auto* b) { return a->start_time < b->start_time; });
}

bool Messages::wants(const ChunkIndex& index) const {
  if (index.end_time < query_.from || ends_before(query_, index.start_time)) {
    return false;
  }
  const auto& here = index.message_index_offsets;
  return here.empty() || std::any_of(here.begin(), here.end(),
                                     [this](const auto& entry) { return channels_.count(entry.first) > 0; });
}

bool Messages::wants(const Message& message) const {
  return message.log_time >= query_.from && !ends_before(query_, message.log_time) &&
         channels_.count(message.channel_id) > 0;
}

bool Messages::next() {
  current_.reset();
  while (next_chunk_ < chunks_.size() &&
         (waiting_.empty() || chunks_[next_chunk_]->start_time <= waiting_.top().log_time)) {
    load(*chunks_[next_chunk_++]);
  }
  if (waiting_.empty()) {
    return false;
  }
  current_ = waiting_.top();
  waiting_.pop();
  return true;
}

void Messages::load(const ChunkIndex& index) {
  // what a scan has found outside chunks counts as one
  std::string prefix;
  recording_->source_.read(index.offset, kRecordPrefix, prefix);
  std::string bytes;
  if (parse_prefix(prefix).opcode == Opcode::kMessage) {
    bytes = prefix + recording_->content(Opcode::kMessage, index.offset, index.length);
  } else {
    const std::string content = recording_->content(Opcode::kChunk, index.offset, index.length);
    try {
      bytes = records_of(parse_chunk(content));
    } catch (const FormatError& error) {
      throw FormatError("the chunk at byte " + std::to_string(index.offset) + ": " + error.what());
    }
  }
  if (bytes.size() > kMostHeld - *held_) {
    throw FormatError("too many chunks overlap in time at byte " + std::to_string(index.offset));
  }
  const auto chunk = std::make_shared<const Loaded>(std::move(bytes), held_);
  ChunkRecords records(chunk->records);
  while (const auto record = records.next()) {
    if (record->opcode != Opcode::kMessage) {
      continue;
    }
    const Message message = parse_message(record->content);
    if (message.log_time < index.start_time || message.log_time > index.end_time) {
      throw FormatError("the chunk at byte " + std::to_string(index.offset) +
                        " has a message outside the times that it tells");
    }
    if (wants(message)) {
      waiting_.push({message.log_time, index.offset, message, chunk});
    }
  }
}

const Channel& Messages::channel() const { return recording_->channels().at(current_->message.channel_id); }

void Messages::parse(google::protobuf::Message& out) const {
  const std::string schema = recording_->schema_name(channel());
  if (schema != out.GetDescriptor()->full_name()) {
    throw FormatError("messages of " + channel().topic + " are " +
                      (schema.empty() ? "of no schema" : schema) + ", not " +
                      out.GetDescriptor()->full_name());
  }
  const std::string_view data = message().data;
  if (!out.ParseFromArray(data.data(), static_cast<int>(data.size()))) {
    throw FormatError("a message of " + channel().topic + " is no " + schema);
  }
}

}  // namespace haptic::recording
