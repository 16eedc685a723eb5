#include "drivers/polhem/polhem_protocol.h"

#include <gtest/gtest.h>

#include "tests/unit/drivers/polhem/polhem_messages.h"

namespace haptic::drivers::polhem {
namespace {

TEST(PolhemProtocol, ReadsCountsAndTheButton) {
  EXPECT_EQ(decode_report(words({1, -2, 32767, 4, 5, 6, 0})), (Reading{{1, -2, 32767}, false}));
  EXPECT_EQ(decode_report(words({-32768, 0, 0, 0, 0, 0, 1})), (Reading{{-32768, 0, 0}, true}));
  std::vector<std::uint8_t> padded = words({1, 2, 3, 0, 0, 0, 0});
  padded.resize(64);
  EXPECT_EQ(decode_report(padded), (Reading{{1, 2, 3}, false}));
}

TEST(PolhemProtocol, AShortReportIsNone) {
  std::vector<std::uint8_t> report = words({1, 2, 3, 4, 5, 6, 7});
  while (!report.empty()) {
    report.pop_back();
    EXPECT_FALSE(decode_report(report));
  }
}

TEST(PolhemProtocol, ReadsDatagramsOfTheArmOnly) {
  std::vector<std::uint8_t> bytes = datagram(100, -200, 300);
  ASSERT_EQ(bytes.size(), kDatagramBytes);
  EXPECT_EQ(decode_datagram(bytes), (Reading{{100, -200, 300}, false}));
  for (const std::size_t at : {0U, 1U, 2U}) {
    std::vector<std::uint8_t> other = bytes;
    other[at] ^= 1U;
    EXPECT_FALSE(decode_datagram(other));
  }
  bytes.push_back(0);
  EXPECT_FALSE(decode_datagram(bytes));
  EXPECT_FALSE(decode_datagram({}));
}

TEST(PolhemProtocol, AsksForCurrentsWithCommandZero) {
  const Message message = currents_message({2000, -2000, 1});
  EXPECT_EQ(std::vector<std::uint8_t>(message.begin(), message.end()), words({2000, -2000, 1, 0, 0, 0, 0}));
}

TEST(PolhemProtocol, PresetsCountersWithCommandOneAndNoCurrent) {
  const Message message = preset_message({0, -7, 6000});
  EXPECT_EQ(std::vector<std::uint8_t>(message.begin(), message.end()), words({0, 0, 0, 1, 0, -7, 6000}));
}

}  // namespace
}  // namespace haptic::drivers::polhem
