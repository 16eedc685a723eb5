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
  EXPECT_TRUE(is_status(Model::kFastrak, status));
  EXPECT_FALSE(is_status(Model::kFastrak, Bytes(status.begin(), status.end() - 1)));
  status[0] = '0';
  EXPECT_FALSE(is_status(Model::kFastrak, status));
  EXPECT_FALSE(is_status(Model::kFastrak, {}));
}

TEST(FastrakProtocol, StartsBinaryRecordsInCentimetresOfTheStationsThatAreWanted) {
  const std::vector<std::string> commands =
      start_commands(Model::kFastrak, {{2, {0.0, 0.0, -1.0}}, {4, {1.0, 0.0, 0.0}}});
  EXPECT_EQ(commands, (std::vector<std::string>{"l1,0\r", "l2,1\r", "O2,2,11,0\r", "H2,0.000,0.000,-1.000\r",
                                                "l3,0\r", "l4,1\r", "O4,2,11,0\r", "H4,1.000,0.000,0.000\r",
                                                "x0,1,0,0\r", "v0,1,0,0\r", "u", "f", "C"}));
}

TEST(LibertyProtocol, ReadsStationPlaceAndRotation) {
  const Bytes bytes = liberty_record_of('L', 'Y', 16, {10.0F, -20.0F, 30.5F}, {0.6F, 0.0F, 0.8F, 0.0F});
  ASSERT_EQ(bytes.size(), kLibertyRecordBytes);
  RecordParser parser(Model::kLiberty);
  const std::vector<Record> records = records_in(parser, bytes);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].station, 16);
  EXPECT_EQ(records[0].error, ' ');
  EXPECT_NEAR(glm::distance(records[0].position, glm::dvec3(0.1, -0.2, 0.305)), 0.0, 1e-9);
  EXPECT_NEAR(records[0].orientation.y, 0.8, 1e-7);
}

TEST(LibertyProtocol, EachModelReadsItsOwnRecordsOnly) {
  const Bytes liberty = liberty_record_of('L', 'Y', 1, {1.0F, 2.0F, 3.0F});
  const Bytes latus = liberty_record_of('L', 'U', 1, {1.0F, 2.0F, 3.0F});
  const Bytes patriot = liberty_record_of('P', 'A', 1, {1.0F, 2.0F, 3.0F});
  const Bytes fastrak = record_of(1, {1.0F, 2.0F, 3.0F});
  const Bytes all = joined({liberty, latus, patriot, fastrak, liberty, latus, patriot, fastrak});
  RecordParser of_liberty(Model::kLiberty);
  EXPECT_EQ(records_in(of_liberty, all).size(), 4U);
  RecordParser of_patriot(Model::kPatriot);
  EXPECT_EQ(records_in(of_patriot, all).size(), 2U);
  RecordParser of_fastrak;
  EXPECT_EQ(records_in(of_fastrak, all).size(), 2U);
}

TEST(LibertyProtocol, FindsRecordsAfterAnyPartOfOne) {
  const Bytes whole = liberty_record_of('P', 'A', 2, {1.0F, 2.0F, 3.0F});
  for (std::size_t from = 0; from <= whole.size(); ++from) {
    RecordParser parser(Model::kPatriot);
    const Bytes part(whole.begin() + static_cast<std::ptrdiff_t>(from), whole.end());
    EXPECT_EQ(records_in(parser, joined({part, whole, whole})).size(), from == 0 ? 3U : 2U) << from;
  }
}

TEST(LibertyProtocol, ARecordOfAnotherSizeOrStationIsNone) {
  Bytes longer = liberty_record_of('P', 'A', 1, {1.0F, 2.0F, 3.0F});
  longer[6] = 30;
  for (const Bytes& bad : {longer, liberty_record_of('P', 'A', 0, {1.0F, 2.0F, 3.0F}),
                           liberty_record_of('P', 'A', 3, {1.0F, 2.0F, 3.0F}),
                           liberty_record_of('P', 'A', 1, {2000.0F, 0.0F, 0.0F}),
                           liberty_record_of('P', 'A', 1, {1.0F, 2.0F, 3.0F}, {2.0F, 0.0F, 0.0F, 0.0F})}) {
    RecordParser parser(Model::kPatriot);
    EXPECT_EQ(records_in(parser, bad).size(), 0U);
  }
}

TEST(LibertyProtocol, StartsBinaryRecordsInCentimetres) {
  EXPECT_EQ(start_commands(Model::kLiberty, {{3, {0.0, 0.0, -1.0}}}),
            (std::vector<std::string>{"F1\r", "U1\r", "O*,2,7,0\r", "H3,0.000,0.000,-1.000\r", "X0,1,0,0\r",
                                      "Y0,1,0,0\r", "C\r"}));
}

}  // namespace
}  // namespace haptic::drivers::fastrak
