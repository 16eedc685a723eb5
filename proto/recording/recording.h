#pragma once
// Reads an MCAP file: what is in it, and its messages in the order of their log_time. A file without a
// summary, or that is cut off, is read through once to learn what its whole records hold; nobody needs to
// care.
//
//     const FileSource file("demo.mcap");
//     Recording recording(file);
//     for (Messages messages = recording.messages({.topics = {"/haptic/objects"}}); messages.next();) {
//       v1::Frame frame;
//       messages.parse(frame);
//     }
//
// Memory: one chunk at a time, and those that overlap with it in log_time. Lengths are checked before
// anything is allocated for them. All here throws FormatError when a file is broken, and IoError.

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "proto/recording/record_stream.h"
#include "proto/recording/records.h"
#include "proto/recording/source.h"

namespace google::protobuf {
class Message;
}

namespace haptic::recording {

/// Which messages. Times are log_time in ns.
struct Query {
  std::vector<std::string> topics{};  // none: all
  std::uint64_t from = 0;
  std::uint64_t to = std::numeric_limits<std::uint64_t>::max();  // exclusive; the maximum: all that follow
};

class Recording;

/// Goes over messages in the order of log_time, and of the file where it is equal.
class Messages {
 public:
  /// Steps to the next message, to the first one to begin with. False at the end.
  bool next();

  // of the message that next() has stepped to:
  const Message& message() const noexcept { return current_->message; }
  const Channel& channel() const;

  /// Parses it. FormatError unless its schema is that of `out`, by name, and its data are.
  void parse(google::protobuf::Message& out) const;

 private:
  friend class Recording;
  Messages(const Recording& recording, Query query);

  // a decompressed chunk, kept while one of its messages waits
  struct Loaded {
    Loaded(std::string bytes, std::shared_ptr<std::uint64_t> held_bytes);
    ~Loaded();
    Loaded(const Loaded&) = delete;
    Loaded& operator=(const Loaded&) = delete;
    std::string records;
    std::shared_ptr<std::uint64_t> held;  // bytes of all that are kept
  };
  struct Waiting {
    std::uint64_t log_time;
    std::uint64_t chunk_offset;
    Message message;
    std::shared_ptr<const Loaded> chunk;
    bool operator>(const Waiting& other) const noexcept;
  };

  void load(const ChunkIndex& index);
  bool wants(const ChunkIndex& index) const;
  bool wants(const Message& message) const;

  const Recording* recording_;
  Query query_;
  std::set<std::uint16_t> channels_;       // of the topics
  std::vector<const ChunkIndex*> chunks_;  // by start time
  std::size_t next_chunk_ = 0;
  std::shared_ptr<std::uint64_t> held_ = std::make_shared<std::uint64_t>(0);
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
  std::optional<Waiting> current_;
};

class Recording {
 public:
  /// `source` outlives this and all Messages of it.
  explicit Recording(const Source& source);

  /// Empty if the file is whole; otherwise why it is not. What is here and below is then what could be read.
  const std::string& damage() const noexcept { return damage_; }

  const Header& header() const noexcept { return header_; }
  const std::map<std::uint16_t, Schema>& schemas() const noexcept { return schemas_; }
  const std::map<std::uint16_t, Channel>& channels() const noexcept { return channels_; }
  const Statistics& statistics() const noexcept { return statistics_; }
  const std::vector<ChunkIndex>& chunks() const noexcept { return chunks_; }
  const std::vector<AttachmentIndex>& attachments() const noexcept { return attachments_; }
  const std::vector<MetadataIndex>& metadata() const noexcept { return metadata_; }

  /// The name of the channel's schema; empty: none.
  std::string schema_name(const Channel& channel) const;

  Messages messages(Query query = {}) const { return Messages(*this, std::move(query)); }

  Attachment read(const AttachmentIndex& index) const;
  Metadata read(const MetadataIndex& index) const;
  /// The first of that name.
  std::optional<Metadata> find_metadata(std::string_view name) const;
  std::optional<Attachment> find_attachment(std::string_view name) const;

 private:
  friend class Messages;

  std::string content(Opcode opcode, std::uint64_t offset, std::uint64_t length) const;
  bool read_summary();
  void take_summary(const Record& record);
  void scan();
  void scan_record(const Record& record);
  void scan_chunk(const Record& record);
  void scan_message(const Message& message, ChunkIndex& index);
  void add(Schema schema);
  void add(Channel channel);
  void forget();

  const Source& source_;
  std::string damage_;
  Header header_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  Statistics statistics_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  std::uint64_t lost_messages_ = 0;  // of no channel
};

}  // namespace haptic::recording
