#include "drivers/fastrak/fastrak_protocol.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

#include "tests/unit/drivers/fastrak/fastrak_records.h"

namespace haptic::drivers::fastrak {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Record> records_in(RecordParser& parser, const Bytes& bytes) {
  std::vector<Record> records;
  Record record;
  for (const std::uint8_t byte : bytes) {
    if (parser.take(byte, record)) records.push_back(record);
  }
  return records;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(FastrakProtocol, ReadsStationPlaceAndRotation) {
  const Bytes bytes = record_of(3, {10.0F, -20.0F, 30.5F}, {0.6F, 0.0F, 0.8F, 0.0F});
  ASSERT_EQ(bytes.size(), kRecordBytes);
  RecordParser parser;
  const std::vector<Record> records = records_in(parser, bytes);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].station, 3);
  EXPECT_EQ(records[0].error, ' ');
  EXPECT_NEAR(glm::distance(records[0].position, glm::dvec3(0.1, -0.2, 0.305)), 0.0, 1e-9);
  EXPECT_NEAR(records[0].orientation.w, 0.6, 1e-7);
  EXPECT_NEAR(records[0].orientation.y, 0.8, 1e-7);
  EXPECT_NEAR(glm::length(records[0].orientation), 1.0, 1e-15);
}

TEST(FastrakProtocol, FindsRecordsAfterAnyPartOfOne) {
  const Bytes whole = record_of(1, {1.0F, 2.0F, 3.0F});
  for (std::size_t from = 0; from <= whole.size(); ++from) {
    RecordParser parser;
    const Bytes part(whole.begin() + static_cast<std::ptrdiff_t>(from), whole.end());
    EXPECT_EQ(records_in(parser, joined({part, whole, whole})).size(), from == 0 ? 3U : 2U) << from;
  }
}

TEST(FastrakProtocol, TheBytesOfItsSyncInsideARecordMisleadNobody) {
  // "01 " three times in the place, as a float is 1.4e-19 or so
  Bytes tricky = record_of(2, {1.0F, 2.0F, 3.0F});
  for (const std::size_t at : {3U, 7U, 11U}) {
    tricky[at] = '0';
    tricky[at + 1] = '1';
    tricky[at + 2] = ' ';
  }
  RecordParser parser;
  const Bytes garbage = {'0', '1', ' ', '0', '1'};
  EXPECT_EQ(records_in(parser, joined({garbage, tricky, tricky, tricky})).size(), 3U);
}

TEST(FastrakProtocol, ARecordThatCannotBeTrueIsNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Bytes& bad :
       {record_of(1, {nan, 0.0F, 0.0F}), record_of(1, {2000.0F, 0.0F, 0.0F}),
        record_of(1, {0.0F, 0.0F, 0.0F}, {0.5F, 0.0F, 0.0F, 0.0F}),
        record_of(1, {0.0F, 0.0F, 0.0F}, {nan, 0.0F, 0.0F, 0.0F}), record_of(5, {0.0F, 0.0F, 0.0F}),
        record_of(0, {0.0F, 0.0F, 0.0F}), record_of(1, {0.0F, 0.0F, 0.0F}, {1, 0, 0, 0}, '\t')}) {
    RecordParser parser;
    const Bytes good = record_of(4, {1.0F, 1.0F, 1.0F});
    const std::vector<Record> records = records_in(parser, joined({bad, good, good}));
    ASSERT_GE(records.size(), 1U);
    for (const Record& record : records) EXPECT_EQ(record.station, 4);
  }
}

TEST(FastrakProtocol, ErrorsAreToldAsTheyCome) {
  RecordParser parser;
  const std::vector<Record> records = records_in(parser, record_of(1, {1.0F, 1.0F, 1.0F}, {1, 0, 0, 0}, 'e'));
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].error, 'e');
}

TEST(FastrakProtocol, AStatusRecordBeginsWithTwoAndEndsItsLine) {
  Bytes status(55, ' ');
  status[0] = '2';
  status[1] = '1';
  status[2] = 'S';
  status[53] = '\r';
  status[54] = '\n';
  EXPECT_TRUE(is_status(status));
  EXPECT_FALSE(is_status(Bytes(status.begin(), status.end() - 1)));
  status[0] = '0';
  EXPECT_FALSE(is_status(status));
  EXPECT_FALSE(is_status({}));
}

TEST(FastrakProtocol, StartsBinaryRecordsInCentimetres) {
  const std::vector<std::string> commands = start_commands(2, {0.0, 0.0, -1.0});
  EXPECT_EQ(commands, (std::vector<std::string>{"l2,1\r", "O2,2,11,0\r", "H2,0.000,0.000,-1.000\r",
                                                "x0,1,0,0\r", "v0,1,0,0\r", "u", "f", "C"}));
}

}  // namespace
}  // namespace haptic::drivers::fastrak
