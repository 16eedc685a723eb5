#include "proto/recording/records.h"

#include <gtest/gtest.h>

#include "proto/recording/error.h"
#include "tests/support/golden_mcap.h"

namespace haptic::recording {
namespace {

const Schema kSchema{1, "S", "protobuf", std::string("\x0a\x00", 2)};
const Channel kChannel{1, 1, "/a", "protobuf", {{"k", "v"}}};

std::string bytes_of(const auto& record) {
  std::string out;
  append(record, out);
  return out;
}

std::string content_of(const auto& record) { return bytes_of(record).substr(kRecordPrefix); }

// every proper beginning of the content is refused
template <class Parse>
void expect_every_cut_refused(const std::string& content, Parse parse) {
  for (std::size_t size = 0; size < content.size(); ++size) {
    EXPECT_THROW(parse(content.substr(0, size)), FormatError) << size;
  }
}

TEST(Records, MakeTheBytesOfFoxglovesWriter) {
  std::string inner;
  append(kSchema, inner);
  append(kChannel, inner);
  append(Message{1, 0, 5, 4, "\x01\x02\x03"}, inner);

  std::string file(kMagic);
  append(Header{"", "t"}, file);
  append(Chunk{5, 5, inner.size(), crc32(0, inner), "", inner}, file);
  append(MessageIndex{1, {{5, 0x4f}}}, file);
  append(DataEnd{crc32(0, file)}, file);
  const std::size_t summary = file.size();
  append(kSchema, file);
  append(kChannel, file);
  append(Statistics{1, 1, 1, 0, 0, 1, 5, 5, {{1, 1}}}, file);
  append(ChunkIndex{5, 5, 26, 162, {{1, 188}}, 31, "", inner.size(), inner.size()}, file);
  const std::size_t offsets = file.size();
  append(SummaryOffset{Opcode::kSchema, 232, 34}, file);
  append(SummaryOffset{Opcode::kChannel, 266, 45}, file);
  append(SummaryOffset{Opcode::kStatistics, 311, 65}, file);
  append(SummaryOffset{Opcode::kChunkIndex, 376, 83}, file);
  Footer footer{summary, offsets, 0};
  const std::string head = bytes_of(footer).substr(0, kFooterBytesInCrc);
  footer.summary_crc = crc32(crc32(0, std::string_view(file).substr(summary)), head);
  append(footer, file);
  file += kMagic;
  EXPECT_EQ(file, test::golden_mcap());
}

TEST(Records, CrcIsThatOfZlib) {
  const std::string text = "123456789";
  EXPECT_EQ(crc32(0, text), 0xcbf43926U);  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(crc32(crc32(0, "1234"), "56789"), 0xcbf43926U);
  EXPECT_EQ(crc32(0, ""), 0U);
}

TEST(Records, AreReadAsTheyWereWritten) {
  EXPECT_EQ(parse_schema(content_of(kSchema)), kSchema);
  EXPECT_EQ(parse_channel(content_of(kChannel)), kChannel);
  const Statistics statistics =
      parse_statistics(content_of(Statistics{70000, 1, 2, 3, 4, 5, 6, 7, {{1, 70000}}}));
  EXPECT_EQ(statistics.message_count, 70000U);
  EXPECT_EQ(statistics.metadata_count, 4U);
  EXPECT_EQ(statistics.channel_message_counts.at(1), 70000U);
  const std::string attachment = content_of(Attachment{1, 2, "n", "text/plain", "data"});
  EXPECT_EQ(parse_attachment(attachment).data, "data");
  EXPECT_EQ(index_attachment(attachment, 30).data_size, 4U);
  EXPECT_EQ(index_attachment(attachment, 30).length, attachment.size() + kRecordPrefix);
  EXPECT_EQ(parse_metadata(content_of(Metadata{"n", {{"a", "b"}}})).metadata.at("a"), "b");
  const MessageIndex index = parse_message_index(content_of(MessageIndex{3, {{1, 2}, {3, 4}}}));
  EXPECT_EQ(index.channel_id, 3);
  EXPECT_EQ(index.entries.at(1), (std::pair<std::uint64_t, std::uint64_t>(3, 4)));
}

TEST(Records, ThatAreTooShortAreRefused) {
  expect_every_cut_refused(content_of(Header{"p", "l"}), parse_header);
  expect_every_cut_refused(content_of(Footer{1, 2, 3}), parse_footer);
  expect_every_cut_refused(content_of(kSchema), parse_schema);
  expect_every_cut_refused(content_of(kChannel), parse_channel);
  expect_every_cut_refused(content_of(Message{1, 2, 3, 4, ""}), parse_message);
  expect_every_cut_refused(content_of(Chunk{1, 2, 3, 4, "zstd", "abc"}), parse_chunk);
  expect_every_cut_refused(content_of(MessageIndex{1, {{2, 3}}}), parse_message_index);
  expect_every_cut_refused(content_of(ChunkIndex{1, 2, 3, 4, {{5, 6}}, 7, "", 8, 9}), parse_chunk_index);
  expect_every_cut_refused(content_of(Attachment{1, 2, "n", "m", "data"}), parse_attachment);
  expect_every_cut_refused(content_of(AttachmentIndex{1, 2, 3, 4, 5, "n", "m"}), parse_attachment_index);
  expect_every_cut_refused(content_of(Statistics{1, 2, 3, 4, 5, 6, 7, 8, {{1, 1}}}), parse_statistics);
  expect_every_cut_refused(content_of(Metadata{"n", {{"a", "b"}}}), parse_metadata);
  expect_every_cut_refused(content_of(MetadataIndex{1, 2, "n"}), parse_metadata_index);
  expect_every_cut_refused(content_of(DataEnd{1}), parse_data_end);
}

TEST(Records, MayGrowAtTheirEnd) {
  EXPECT_EQ(parse_schema(content_of(kSchema) + "new"), kSchema);
  EXPECT_EQ(parse_channel(content_of(kChannel) + "new"), kChannel);
}

TEST(Records, AnAttachmentWithAWrongCrcIsRefused) {
  std::string content = content_of(Attachment{1, 2, "n", "m", "data"});
  content[content.find("data")] = 'D';
  EXPECT_THROW(parse_attachment(content), FormatError);
  // 0 means that none was computed
  content.replace(content.size() - 4, 4, 4, '\0');
  EXPECT_EQ(parse_attachment(content).data, "Data");
}

TEST(Records, AKeyThatOccursTwiceIsRefused) {
  std::string content = content_of(Metadata{"n", {{"a", "b"}, {"c", "d"}}});
  content[content.find('c')] = 'a';
  EXPECT_THROW(parse_metadata(content), FormatError);
}

TEST(Records, ASchemaWithoutANumberIsRefused) {
  EXPECT_THROW(parse_schema(content_of(Schema{0, "S", "protobuf", ""})), FormatError);
}

}  // namespace
}  // namespace haptic::recording
