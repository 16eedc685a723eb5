#include "proto/recording/recover.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "proto/recording/error.h"
#include "proto/recording/recording.h"
#include "tests/support/small_recording.h"

namespace haptic::recording {
namespace {

using test::hear;
using test::Heard;
using test::MemorySink;
using test::small_messages;
using test::small_recording;

struct Outcome {
  Recovered told;
  std::string bytes;
};

Outcome recover_bytes(const std::string& bytes) {
  const MemorySource source(bytes);
  MemorySink sink;
  Writer writer(sink, test::by_hand());
  Recovered told = recover(source, writer);
  return {told, sink.bytes};
}

std::vector<Heard> hear_bytes(const std::string& bytes) {
  const MemorySource source(bytes);
  const Recording recording(source);
  EXPECT_EQ(recording.damage(), "");
  return hear(recording);
}

TEST(Recover, AWholeFileLosesNothing) {
  const Outcome outcome = recover_bytes(small_recording());
  EXPECT_EQ(outcome.told.damage, "");
  EXPECT_TRUE(outcome.told.lossless());
  EXPECT_EQ(outcome.told.messages, 6U);
  EXPECT_EQ(outcome.told.attachments, 1U);
  EXPECT_EQ(hear_bytes(outcome.bytes), small_messages());
}

TEST(Recover, CutOffAtAnyByteItMakesAWholeFileOfEveryWholeChunk) {
  const std::string whole = small_recording();
  const MemorySource original(whole);
  const std::vector<ChunkIndex> chunks = Recording(original).chunks();
  for (std::size_t size = kMagic.size(); size < whole.size(); ++size) {
    const Outcome outcome = recover_bytes(whole.substr(0, size));
    EXPECT_NE(outcome.told.damage, "") << size;
    std::vector<Heard> expected = small_messages();
    expected.resize(2 * static_cast<std::size_t>(
                            std::count_if(chunks.begin(), chunks.end(), [size](const ChunkIndex& chunk) {
                              return chunk.offset + chunk.length <= size;
                            })));
    EXPECT_EQ(hear_bytes(outcome.bytes), expected) << size;
  }
}

TEST(Recover, CutOffWithinTheSummaryNothingIsLost) {
  const std::string whole = small_recording();
  const Outcome outcome = recover_bytes(whole.substr(0, whole.size() - 60));
  EXPECT_TRUE(outcome.told.lossless());
  EXPECT_NE(outcome.told.damage, "");
  EXPECT_EQ(hear_bytes(outcome.bytes), small_messages());
  const MemorySource source(outcome.bytes);
  EXPECT_EQ(Recording(source).find_attachment("mesh")->data, "vertices");
  EXPECT_EQ(Recording(source).find_metadata("who")->metadata.at("program"), "test");
}

TEST(Recover, AChunkWithAWrongCrcIsKeptAndTold) {
  std::string bytes = small_recording();
  bytes[bytes.find("message 3")] = 'M';
  const Outcome outcome = recover_bytes(bytes);
  EXPECT_NE(outcome.told.damage.find("CRC"), std::string::npos);
  std::vector<Heard> expected = small_messages();
  expected[2].data = "Message 3";
  EXPECT_EQ(hear_bytes(outcome.bytes), expected);
}

TEST(Recover, AChunkThatCannotBeDecompressedIsSkipped) {
  std::string bytes(kMagic);
  append(Header{"", "test"}, bytes);
  append(Channel{1, 0, "/a", "", {}}, bytes);
  append(Chunk{1, 1, 100, 0, "zstd", "rubbish"}, bytes);
  append(Message{1, 0, 2, 2, "after"}, bytes);
  const Outcome outcome = recover_bytes(bytes);
  EXPECT_EQ(outcome.told.lost_chunks, 1U);
  EXPECT_FALSE(outcome.told.lossless());
  EXPECT_EQ(hear_bytes(outcome.bytes), (std::vector<Heard>{{"/a", 2, "after"}}));
}

TEST(Recover, MessagesOfUnknownChannelsAreCounted) {
  std::string bytes(kMagic);
  append(Channel{1, 0, "/a", "", {}}, bytes);
  append(Message{9, 0, 1, 1, "lost"}, bytes);
  append(Message{1, 0, 2, 2, "kept"}, bytes);
  const Outcome outcome = recover_bytes(bytes);
  EXPECT_EQ(outcome.told.lost_messages, 1U);
  EXPECT_EQ(outcome.told.messages, 1U);
}

TEST(Recover, ChannelsInsideChunksAreFound) {
  std::string inner;
  append(Schema{1, "S", "protobuf", ""}, inner);
  append(Channel{1, 1, "/a", "protobuf", {}}, inner);
  append(Message{1, 0, 5, 5, "x"}, inner);
  std::string bytes(kMagic);
  append(Header{"", "other"}, bytes);
  append(Chunk{5, 5, inner.size(), 0, "", inner}, bytes);
  const Outcome outcome = recover_bytes(bytes);
  EXPECT_EQ(hear_bytes(outcome.bytes), (std::vector<Heard>{{"/a", 5, "x"}}));
}

TEST(Recover, BytesThatAreLostAtTheEndAreCounted) {
  std::string bytes(kMagic);
  append(Header{"", "test"}, bytes);
  EXPECT_EQ(recover_bytes(bytes + std::string(5, '\x06')).told.bytes_beyond, 5U);
}

TEST(Recover, WhatIsNoMcapFileIsRefused) { EXPECT_THROW(recover_bytes("something else"), FormatError); }

}  // namespace
}  // namespace haptic::recording
