#pragma once
// Writes an MCAP file so that whatever happens to the program, the machine or the disk, all but the last
// chunk can be read:
//
//     magic | Header | Schema, Channel, ... | Chunk, MessageIndex, ... | Chunk, ... | DataEnd | summary | ...
//             at top level, before the         at most 1 MiB or half a second each,
//             first message that needs them    in one write, then synced
//
// A file that was not closed lacks the summary; `Recording` (recording.h) reads it all the same, and
// recover() (recover.h) makes a whole one of it. One thread at a time.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "proto/recording/compression.h"
#include "proto/recording/records.h"
#include "proto/recording/sink.h"

namespace haptic::recording {

struct WriterOptions {
  std::string library;                                 // Header.library: "program/version"
  std::uint64_t chunk_bytes = std::uint64_t{1} << 20;  // before compression; one message more at most
  std::uint64_t chunk_ns = 500'000'000;                // of log_time
  bool compress = true;
};

/// Every function throws IoError when the sink fails. The file is then cut back to what was whole, if the
/// sink can; the messages of the chunk at hand are lost; add() and write() throw from then on, but close()
/// still tries to end the file well.
class Writer {
 public:
  /// `sink` is empty and outlives this.
  Writer(Sink& sink, WriterOptions options);

  /// Ids are chosen by the caller. What is known already, with the same content, is not written again; an id
  /// with another content, or a channel of an unknown schema, is a FormatError.
  void add(const Schema& schema);
  void add(const Channel& channel);

  /// Its channel must be known: FormatError.
  void write(const Message& message);

  void add(const Attachment& attachment);
  void add(const Metadata& metadata);

  /// Ends the chunk at hand, so that what was written is safe.
  void flush();

  /// The rest of the file; nothing may be written after it. Without it the file is like one that was cut off.
  void close();

  /// What the file has, as its summary tells it; the chunk at hand is not yet part of it.
  const Statistics& statistics() const noexcept { return statistics_; }

  /// Bytes of the file so far.
  std::uint64_t size() const noexcept { return size_; }

 private:
  struct OpenChunk {
    std::string records;
    std::map<std::uint16_t, MessageIndex> index;
    std::uint64_t start_time = 0;
    std::uint64_t end_time = 0;
    std::uint64_t messages = 0;
  };

  void put(std::string_view bytes);
  void count(const OpenChunk& chunk);
  std::string summary(std::uint64_t start) const;

  Sink& sink_;
  WriterOptions options_;
  Compressor compressor_;
  OpenChunk chunk_;
  std::string buffer_;  // of what is about to be put

  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;
  std::string failure_;  // empty: none
  bool torn_ = false;    // part of a record is at the end of the file, and stays there
  bool closed_ = false;

  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  Statistics statistics_;
};

}  // namespace haptic::recording
