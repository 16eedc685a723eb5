#include "proto/recording/writer.h"

#include <gtest/gtest.h>

#include "proto/recording/error.h"
#include "proto/recording/recording.h"
#include "proto/recording/recover.h"
#include "tests/support/small_recording.h"

namespace haptic::recording {
namespace {

using test::by_hand;
using test::hear;
using test::kSecond;
using test::MemorySink;
using test::small_messages;

Recording read(const MemorySource& source) { return Recording(source); }

TEST(Writer, WhatItWritesIsReadBack) {
  const std::string bytes = test::small_recording();
  const MemorySource source(bytes);
  const Recording recording = read(source);
  EXPECT_EQ(recording.damage(), "");
  EXPECT_EQ(recording.header().library, "test");
  EXPECT_EQ(hear(recording), small_messages());
  EXPECT_EQ(recording.statistics().message_count, 6U);
  EXPECT_EQ(recording.statistics().chunk_count, 3U);
  EXPECT_EQ(recording.statistics().start_time, kSecond);
  EXPECT_EQ(recording.statistics().end_time, 6 * kSecond);
  EXPECT_EQ(recording.statistics().channel_message_counts.at(1), 3U);
  EXPECT_EQ(recording.find_attachment("mesh")->data, "vertices");
  EXPECT_EQ(recording.find_metadata("who")->metadata.at("program"), "test");
}

TEST(Writer, TheCrcOfTheDataCoversEveryByteBeforeDataEnd) {
  const std::string bytes = test::small_recording();
  const MemorySource source(bytes);
  RecordStream stream(source);
  bool seen = false;
  while (const auto record = stream.next()) {
    if (record->opcode == Opcode::kDataEnd) {
      seen = true;
      const std::string_view before = std::string_view(bytes).substr(0, record->offset);
      EXPECT_EQ(parse_data_end(record->content).data_section_crc, crc32(0, before));
    }
  }
  EXPECT_TRUE(seen);
  EXPECT_EQ(stream.damage(), "");
}

TEST(Writer, SchemasAndChannelsStandBeforeTheFirstChunkOutsideOfIt) {
  const std::string bytes = test::small_recording();
  const MemorySource source(bytes);
  RecordStream stream(source);
  std::vector<Opcode> opcodes;
  while (const auto record = stream.next()) {
    opcodes.push_back(record->opcode);
  }
  const std::vector<Opcode> expected = {
      Opcode::kHeader,        Opcode::kSchema,          Opcode::kChannel,       Opcode::kChannel,
      Opcode::kMetadata,      Opcode::kChunk,           Opcode::kMessageIndex,  Opcode::kMessageIndex,
      Opcode::kChunk,         Opcode::kMessageIndex,    Opcode::kMessageIndex,  Opcode::kAttachment,
      Opcode::kChunk,         Opcode::kMessageIndex,    Opcode::kMessageIndex,  Opcode::kDataEnd,
      Opcode::kSchema,        Opcode::kChannel,         Opcode::kChannel,       Opcode::kStatistics,
      Opcode::kMetadataIndex, Opcode::kAttachmentIndex, Opcode::kChunkIndex,    Opcode::kChunkIndex,
      Opcode::kChunkIndex,    Opcode::kSummaryOffset,   Opcode::kSummaryOffset, Opcode::kSummaryOffset,
      Opcode::kSummaryOffset, Opcode::kSummaryOffset,   Opcode::kSummaryOffset, Opcode::kFooter};
  EXPECT_EQ(opcodes, expected);
}

TEST(Writer, AChunkHasNoMoreThanItsTime) {
  MemorySink sink;
  Writer writer(sink, {.library = "test", .chunk_ns = 500});
  writer.add(Channel{1, 0, "/a", "", {}});
  for (std::uint64_t time = 0; time < 1500; time += 100) {
    writer.write({1, 0, time, time, "x"});
  }
  writer.close();
  ASSERT_EQ(writer.statistics().chunk_count, 3U);  // 0 to 400, 500 to 900, 1000 to 1400
  const MemorySource source(sink.bytes);
  EXPECT_EQ(read(source).chunks()[0].end_time, 400U);
  EXPECT_EQ(read(source).chunks()[1].start_time, 500U);
}

TEST(Writer, AChunkHasNoMoreThanItsBytesAndOneMessage) {
  MemorySink sink;
  Writer writer(sink, {.library = "test", .chunk_bytes = 1000});
  writer.add(Channel{1, 0, "/a", "", {}});
  const std::string data(369, 'x');  // 400 with its head: three exceed 1000
  for (int i = 0; i < 6; ++i) {
    writer.write({1, 0, 0, 0, data});
  }
  writer.close();
  EXPECT_EQ(writer.statistics().chunk_count, 2U);
}

TEST(Writer, EachChunkIsSynced) {
  MemorySink sink;
  Writer writer(sink, by_hand());
  test::write_small(writer);
  EXPECT_EQ(sink.syncs, 3 + 1);  // and the end
}

TEST(Writer, CompressesLargeChunks) {
  MemorySink sink;
  Writer writer(sink, by_hand());
  writer.add(Channel{1, 0, "/a", "", {}});
  const std::string data(100'000, 'x');
  writer.write({1, 0, 1, 1, data});
  writer.close();
  EXPECT_LT(sink.bytes.size(), 2000U);
  const MemorySource source(sink.bytes);
  const Recording recording = read(source);
  EXPECT_EQ(recording.chunks().at(0).compression, "zstd");
  EXPECT_EQ(hear(recording).at(0).data, data);
}

TEST(Writer, KnownSchemasAndChannelsAreNotWrittenAgain) {
  MemorySink sink;
  Writer writer(sink, by_hand());
  writer.add(Schema{1, "S", "protobuf", ""});
  writer.add(Channel{1, 1, "/a", "protobuf", {}});
  const std::uint64_t size = writer.size();
  writer.add(Schema{1, "S", "protobuf", ""});
  writer.add(Channel{1, 1, "/a", "protobuf", {}});
  EXPECT_EQ(writer.size(), size);
}

TEST(Writer, RefusesWhatWouldMakeTheFileWrong) {
  MemorySink sink;
  Writer writer(sink, by_hand());
  writer.add(Schema{1, "S", "protobuf", ""});
  writer.add(Channel{1, 1, "/a", "protobuf", {}});
  EXPECT_THROW(writer.add(Schema{1, "T", "protobuf", ""}), FormatError);
  EXPECT_THROW(writer.add(Channel{1, 1, "/b", "protobuf", {}}), FormatError);
  EXPECT_THROW(writer.add(Channel{2, 9, "/b", "protobuf", {}}), FormatError);
  EXPECT_THROW(writer.write({7, 0, 0, 0, ""}), FormatError);
}

// writes until the disk is full, as a program would, and closes; what was safe before is returned
std::uint64_t write_until_full(MemorySink& sink) {
  std::uint64_t safe = 0;
  try {
    Writer writer(sink, by_hand());
    try {
      test::write_small(writer, false);
    } catch (const IoError&) {
      // it is told, and the file ended
    }
    safe = writer.statistics().message_count;
    writer.close();
  } catch (const IoError&) {
    return safe;
  }
  return safe;
}

std::vector<test::Heard> first_messages(std::uint64_t count) {
  std::vector<test::Heard> heard = small_messages();
  heard.resize(count);
  return heard;
}

TEST(Writer, AFullDiskAtAnyByteLeavesAFileWithEveryChunkBefore) {
  const std::size_t size = test::small_recording().size();
  for (std::uint64_t room = 0; room < size; ++room) {
    for (const bool can_truncate : {true, false}) {
      MemorySink sink;
      sink.room = room;
      sink.can_truncate = can_truncate;
      const std::uint64_t safe = write_until_full(sink);
      if (sink.bytes.size() < kMagic.size()) {
        EXPECT_EQ(safe, 0U);
        continue;
      }
      const MemorySource source(sink.bytes);
      const std::vector<test::Heard> heard = hear(read(source));
      EXPECT_EQ(heard, first_messages(heard.size())) << room;
      // a torn chunk that stays is readable if only its indexes are torn
      EXPECT_GE(heard.size(), safe) << room;
      EXPECT_TRUE(heard.size() == safe || !can_truncate) << room;
    }
  }
}

// bytes that do not compress
std::string noise(std::size_t size) {
  std::string bytes;
  for (std::uint32_t state = 1; bytes.size() < size; state = state * 1664525U + 1013904223U) {
    bytes.push_back(static_cast<char>(state >> 24U));
  }
  return bytes;
}

TEST(Writer, AChunkThatDoesNotFitIsTakenBackAndTheFileStillEndsWell) {
  MemorySink sink;
  Writer writer(sink, by_hand());
  test::write_small(writer, false);
  sink.room = sink.bytes.size() + 2000;  // enough for the summary, not for what comes now
  const std::string data = noise(4000);
  writer.write({1, 7, 7 * kSecond, 7 * kSecond, data});
  EXPECT_THROW(writer.flush(), IoError);
  EXPECT_THROW(writer.write({1, 8, 8 * kSecond, 8 * kSecond, "late"}), IoError);
  writer.close();
  const MemorySource source(sink.bytes);
  EXPECT_EQ(read(source).damage(), "");
  EXPECT_EQ(hear(read(source)), small_messages());
}

TEST(Writer, ALastChunkThatDoesNotFitIsToldByCloseWhichStillEndsTheFile) {
  MemorySink sink;
  Writer writer(sink, by_hand());
  test::write_small(writer, false);
  sink.room = sink.bytes.size() + 2000;
  const std::string data = noise(4000);
  writer.write({1, 7, 7 * kSecond, 7 * kSecond, data});
  EXPECT_THROW(writer.close(), IoError);
  const MemorySource source(sink.bytes);
  EXPECT_EQ(read(source).damage(), "");
  EXPECT_EQ(hear(read(source)), small_messages());
}

}  // namespace
}  // namespace haptic::recording
