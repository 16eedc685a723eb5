#include "proto/recording/recover.h"

#include <vector>

#include "proto/recording/error.h"
#include "proto/recording/record_stream.h"

namespace haptic::recording {
namespace {

class Recovery {
 public:
  Recovery(const Source& source, Writer& writer) : source_(source), stream_(source), writer_(writer) {}

  Recovered run() {
    while (const auto record = stream_.next()) {
      if (record->opcode == Opcode::kDataEnd || record->opcode == Opcode::kFooter) {
        in_data_ = false;  // on to the end only to see whether there is one
      }
      if (in_data_) {
        take(*record);
      }
    }
    if (!stream_.damage().empty()) {
      result_.damage = stream_.damage();
      // without what comes after the data nothing is lost
      result_.bytes_beyond = in_data_ ? source_.size() - stream_.position() : 0;
    }
    writer_.close();
    return result_;
  }

 private:
  void take(const Record& record) {
    try {
      switch (record.opcode) {
        case Opcode::kSchema:
          writer_.add(parse_schema(record.content));
          break;
        case Opcode::kChannel:
          writer_.add(parse_channel(record.content));
          break;
        case Opcode::kMessage:
          copy(record);
          break;
        case Opcode::kChunk:
          take_chunk(record);
          break;
        case Opcode::kAttachment:
          writer_.flush();
          writer_.add(parse_attachment(record.content));
          ++result_.attachments;
          break;
        case Opcode::kMetadata:
          writer_.add(parse_metadata(record.content));
          break;
        default:
          break;  // indexes are made anew
      }
    } catch (const FormatError& error) {
      ++result_.lost_records;
      tell(record, error.what());
    }
  }

  void take_chunk(const Record& record) {
    std::string bytes;
    try {
      const Chunk chunk = parse_chunk(record.content);
      bytes = records_of(chunk, CheckCrc::kNo);
      if (chunk.uncompressed_crc != 0 && chunk.uncompressed_crc != crc32(0, bytes)) {
        tell(record, "its bytes do not have the CRC that it tells");
      }
    } catch (const FormatError& error) {
      ++result_.lost_chunks;
      tell(record, error.what());
      return;
    }
    ++result_.chunks;
    ChunkRecords records(bytes);
    while (const auto inner = records.next()) {
      if (inner->opcode == Opcode::kSchema || inner->opcode == Opcode::kChannel ||
          inner->opcode == Opcode::kMessage) {
        take({inner->opcode, record.offset, inner->content});
      }
    }
  }

  void copy(const Record& record) {
    const Message message = parse_message(record.content);
    try {
      writer_.write(message);
      ++result_.messages;
    } catch (const FormatError& error) {
      ++result_.lost_messages;
      tell(record, error.what());
    }
  }

  // the first is told
  void tell(const Record& record, const std::string& what) {
    if (result_.damage.empty()) {
      result_.damage = "the record at byte " + std::to_string(record.offset) + " is broken: " + what;
    }
  }

  const Source& source_;
  RecordStream stream_;
  Writer& writer_;
  Recovered result_;
  bool in_data_ = true;
};

}  // namespace

std::string library_of(const Source& source) {
  RecordStream stream(source);
  try {
    if (const auto first = stream.next(); first && first->opcode == Opcode::kHeader) {
      return parse_header(first->content).library;
    }
  } catch (const FormatError&) {
    return "";  // only this record is broken
  }
  return "";
}

Recovered recover(const Source& source, Writer& writer) { return Recovery(source, writer).run(); }

}  // namespace haptic::recording
