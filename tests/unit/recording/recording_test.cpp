#include "proto/recording/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "haptic/v1/telemetry.pb.h"
#include "proto/recording/compression.h"
#include "proto/recording/error.h"
#include "tests/support/golden_mcap.h"
#include "tests/support/small_recording.h"

namespace haptic::recording {
namespace {

using test::hear;
using test::Heard;
using test::kSecond;
using test::small_messages;
using test::small_recording;

// a file made of records by hand
class Handmade {
 public:
  Handmade() : bytes(kMagic) { append(Header{"", "test"}, bytes); }

  template <class Record>
  Handmade& add(const Record& record) {
    append(record, bytes);
    return *this;
  }

  Handmade& add_channel() { return add(Channel{1, 0, "/a", "", {}}); }

  /// `uncompressed_size` and CRC as told; nothing else is made up.
  Handmade& add_chunk(std::string_view records, std::uint64_t start, std::uint64_t end,
                      const std::string& compression, std::uint64_t size, std::uint32_t crc) {
    return add(Chunk{start, end, size, crc, compression, records});
  }

  Handmade& add_chunk(const std::vector<std::uint64_t>& times) {
    std::string records;
    for (const std::uint64_t time : times) {
      const std::string data = std::to_string(time);
      append(Message{1, 0, time, time, data}, records);
    }
    const auto [least, greatest] = std::minmax_element(times.begin(), times.end());
    return add_chunk(records, *least, *greatest, "", records.size(), crc32(0, records));
  }

  /// Ends it without a summary.
  const std::string& end() {
    add(DataEnd{0}).add(Footer{});
    return bytes += kMagic;
  }

  std::string bytes;
};

std::vector<std::uint64_t> times_of(const std::vector<Heard>& heard) {
  std::vector<std::uint64_t> times;
  for (const Heard& message : heard) {
    times.push_back(message.log_time);
  }
  return times;
}

std::string damage_of(const std::string& bytes) {
  const MemorySource source(bytes);
  return Recording(source).damage();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Recording, ReadsWhatFoxglovesWriterMakes) {
  const std::string bytes = test::golden_mcap();
  const MemorySource source(bytes);
  const Recording recording(source);
  EXPECT_EQ(recording.damage(), "");
  EXPECT_EQ(recording.header().library, "t");
  EXPECT_EQ(recording.channels().at(1).metadata.at("k"), "v");
  EXPECT_EQ(recording.schema_name(recording.channels().at(1)), "S");
  EXPECT_EQ(hear(recording), (std::vector<Heard>{{"/a", 5, "\x01\x02\x03"}}));
}

TEST(Recording, ChoosesTopics) {
  const std::string bytes = small_recording();
  const MemorySource source(bytes);
  const Recording recording(source);
  EXPECT_EQ(times_of(hear(recording, {.topics = {"/a"}})),
            (std::vector<std::uint64_t>{2 * kSecond, 4 * kSecond, 6 * kSecond}));
  EXPECT_EQ(times_of(hear(recording, {.topics = {"/a", "/b"}})).size(), 6U);
  EXPECT_TRUE(hear(recording, {.topics = {"/c"}}).empty());
}

TEST(Recording, ChoosesTimesFromTheFirstUpToButNotTheLast) {
  const std::string bytes = small_recording();
  const MemorySource source(bytes);
  const Recording recording(source);
  EXPECT_EQ(times_of(hear(recording, {.from = 2 * kSecond, .to = 4 * kSecond})),
            (std::vector<std::uint64_t>{2 * kSecond, 3 * kSecond}));
  EXPECT_TRUE(hear(recording, {.from = 7 * kSecond}).empty());
  EXPECT_TRUE(hear(recording, {.to = kSecond}).empty());
}

TEST(Recording, WithoutALastTimeEvenTheGreatestIsRead) {
  constexpr std::uint64_t kGreatest = std::numeric_limits<std::uint64_t>::max();
  const std::string bytes = Handmade().add_channel().add_chunk({1, kGreatest}).add_chunk({kGreatest}).end();
  const MemorySource source(bytes);
  const Recording recording(source);
  EXPECT_EQ(times_of(hear(recording)), (std::vector<std::uint64_t>{1, kGreatest, kGreatest}));
  EXPECT_EQ(times_of(hear(recording, {.to = kGreatest - 1})), (std::vector<std::uint64_t>{1}));
}

TEST(Recording, MessagesComeInTheOrderOfTimeThoughChunksOverlap) {
  const std::string bytes =
      Handmade().add_channel().add_chunk({5, 1, 9}).add_chunk({4, 2}).add_chunk({20, 10}).end();
  const MemorySource source(bytes);
  EXPECT_EQ(times_of(hear(Recording(source))), (std::vector<std::uint64_t>{1, 2, 4, 5, 9, 10, 20}));
}

TEST(Recording, MessagesOfOneTimeComeInTheOrderOfTheFile) {
  std::string records;
  append(Message{1, 0, 3, 3, "first"}, records);
  append(Message{1, 0, 3, 3, "second"}, records);
  Handmade file;
  file.add_channel().add_chunk(records, 3, 3, "", records.size(), 0).add_chunk({3});
  const MemorySource source(file.end());
  const std::vector<Heard> heard = hear(Recording(source));
  ASSERT_EQ(heard.size(), 3U);
  EXPECT_EQ(heard[0].data, "first");
  EXPECT_EQ(heard[1].data, "second");
  EXPECT_EQ(heard[2].data, "3");
}

TEST(Recording, MessagesOutsideChunksAreRead) {
  const std::string bytes =
      Handmade().add_channel().add(Message{1, 0, 7, 7, "late"}).add(Message{1, 0, 3, 3, "early"}).end();
  const MemorySource source(bytes);
  EXPECT_EQ(times_of(hear(Recording(source))), (std::vector<std::uint64_t>{3, 7}));
}

TEST(Recording, AFileWithoutASummaryIsWholeAndCounted) {
  const std::string bytes = Handmade().add_channel().add_chunk({5, 1, 9}).end();
  const MemorySource source(bytes);
  const Recording recording(source);
  EXPECT_EQ(recording.damage(), "");
  EXPECT_EQ(recording.statistics().message_count, 3U);
  EXPECT_EQ(recording.statistics().start_time, 1U);
  EXPECT_EQ(recording.statistics().end_time, 9U);
  EXPECT_EQ(recording.statistics().channel_message_counts.at(1), 3U);
}

// where each chunk of the small recording ends, its indexes left away: those are not needed
std::vector<std::uint64_t> chunk_ends(const std::string& bytes) {
  const MemorySource source(bytes);
  const Recording recording(source);
  std::vector<std::uint64_t> ends;
  for (const ChunkIndex& chunk : recording.chunks()) {
    ends.push_back(chunk.offset + chunk.length);
  }
  return ends;
}

TEST(Recording, CutOffAtAnyByteEveryWholeChunkIsRead) {
  const std::string whole = small_recording();
  const std::vector<std::uint64_t> ends = chunk_ends(whole);
  ASSERT_EQ(ends.size(), 3U);
  for (std::size_t size = kMagic.size(); size < whole.size(); ++size) {
    const std::string cut = whole.substr(0, size);
    const MemorySource source(cut);
    const Recording recording(source);
    EXPECT_NE(recording.damage(), "") << size;
    std::vector<Heard> expected = small_messages();
    expected.resize(2 * static_cast<std::size_t>(std::count_if(
                            ends.begin(), ends.end(), [size](std::uint64_t end) { return end <= size; })));
    EXPECT_EQ(hear(recording), expected) << size;
    EXPECT_EQ(recording.statistics().message_count, expected.size()) << size;
  }
}

TEST(Recording, WhatDoesNotBeginLikeMcapIsRefused) {
  for (const std::string& bytes : {std::string(), std::string("\x89MCAP"), std::string(100, 'x')}) {
    const MemorySource source(bytes);
    EXPECT_THROW(Recording{source}, FormatError);
  }
}

TEST(Recording, BytesAfterTheEndAreDamage) {
  EXPECT_TRUE(contains(damage_of(small_recording() + "x"), "goes on after its end"));
}

TEST(Recording, AnyByteOfTheSummaryThatIsFlippedIsNoticedAndTheMessagesRead) {
  const std::string whole = small_recording();
  const MemorySource original(whole);
  std::string tail;
  original.read(whole.size() - kTail, kTail, tail);
  const auto start = static_cast<std::size_t>(
      parse_footer(std::string_view(tail).substr(kRecordPrefix, kFooterContent)).summary_start);
  // up to the CRC itself: changed to another value it is wrong, too
  for (std::size_t i = start; i < whole.size() - kMagic.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x40);
    const MemorySource source(bytes);
    const Recording recording(source);
    EXPECT_NE(recording.damage(), "") << i;
    EXPECT_EQ(hear(recording), small_messages()) << i;
  }
}

TEST(Recording, AChunkWhoseBytesAreFlippedIsRefusedByItsPlace) {
  std::string bytes = small_recording();
  const std::size_t at = bytes.find("message 3");
  bytes[at] = 'M';
  const MemorySource source(bytes);
  const Recording recording(source);  // the summary is as it was
  try {
    hear(recording);
    FAIL() << "the CRC was not checked";
  } catch (const FormatError& error) {
    EXPECT_TRUE(contains(error.what(), "the chunk at byte")) << error.what();
    EXPECT_TRUE(contains(error.what(), "CRC")) << error.what();
  }
}

TEST(Recording, WithoutASummaryABrokenChunkIsSkippedAndTold) {
  Handmade file;
  file.add_channel().add_chunk({1}).add_chunk("no records", 2, 2, "", 10, 1).add_chunk({3});
  const MemorySource source(file.end());
  const Recording recording(source);
  EXPECT_TRUE(contains(recording.damage(), "CRC")) << recording.damage();
  EXPECT_EQ(times_of(hear(recording)), (std::vector<std::uint64_t>{1, 3}));
}

TEST(Recording, SizesThatLieAreRefused) {
  const std::string records = "some bytes that are no zstd";
  const auto damage = [&](const std::string& compression, std::uint64_t size) {
    return damage_of(Handmade().add_chunk(records, 0, 0, compression, size, 0).end());
  };
  EXPECT_TRUE(contains(damage("", records.size() + 1), "tells"));
  EXPECT_TRUE(contains(damage("", std::uint64_t{1} << 60U), "larger than"));
  EXPECT_TRUE(contains(damage("zstd", kLargestChunk), "zstd"));
  EXPECT_TRUE(contains(damage("lz4", 1000), "lz4"));
  EXPECT_TRUE(contains(damage("zip", 1000), "zip"));
}

TEST(Recording, ACompressedChunkWithMoreThanItTellsIsRefused) {
  Compressor compressor;
  const std::string records(100'000, 'x');
  const std::string compressed(compressor.compress(records));
  ASSERT_FALSE(compressed.empty());
  EXPECT_EQ(decompress("zstd", compressed, records.size()), records);
  EXPECT_THROW(decompress("zstd", compressed, records.size() - 1), FormatError);
  EXPECT_THROW(decompress("zstd", compressed, records.size() + 1), FormatError);
  EXPECT_THROW(decompress("zstd", compressed + "x", records.size()), FormatError);
  EXPECT_THROW(decompress("zstd", compressed.substr(0, compressed.size() - 1), records.size()), FormatError);
}

TEST(Recording, ARecordLongerThanTheFileEndsIt) {
  std::string bytes = Handmade().add_channel().add_chunk({1}).bytes;
  bytes += '\x05';
  bytes += std::string(8, '\xff');
  EXPECT_TRUE(contains(damage_of(bytes), "cut off"));
}

TEST(Recording, MessagesWithoutAChannelAreTold) {
  const std::string damage = damage_of(Handmade().add_chunk({1, 2}).end());
  EXPECT_TRUE(contains(damage, "channels that it does not tell: 2")) << damage;
}

TEST(Recording, AMessageIsParsedOnlyAsWhatItsSchemaSays) {
  v1::Event event;
  event.set_message("armed");
  const std::string data = event.SerializeAsString();
  const std::string bytes = Handmade()
                                .add(Schema{1, "haptic.v1.Event", "protobuf", ""})
                                .add(Channel{1, 1, "/events", "protobuf", {}})
                                .add(Channel{2, 0, "/raw", "", {}})
                                .add(Message{1, 0, 1, 1, data})
                                .add(Message{1, 0, 2, 2, "\x12\x7f"})
                                .add(Message{2, 0, 3, 3, data})
                                .end();
  const MemorySource source(bytes);
  const Recording recording(source);
  Messages messages = recording.messages();
  v1::Event read;
  v1::Stats other;
  ASSERT_TRUE(messages.next());
  messages.parse(read);
  EXPECT_EQ(read.message(), "armed");
  EXPECT_THROW(messages.parse(other), FormatError);
  ASSERT_TRUE(messages.next());  // its data are no such message
  EXPECT_THROW(messages.parse(read), FormatError);
  ASSERT_TRUE(messages.next());
  EXPECT_THROW(messages.parse(read), FormatError);
  EXPECT_FALSE(messages.next());
}

}  // namespace
}  // namespace haptic::recording
