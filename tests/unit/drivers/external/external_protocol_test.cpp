#include "drivers/external/external_protocol.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "drivers/device_link.h"

namespace haptic::drivers::external {
namespace {

constexpr Nanoseconds kNow = 5'000'000'000;

haptic_sample good_sample() {
  haptic_sample sample{};
  sample.magic = HAPTIC_DEVICE_MAGIC;
  sample.version = HAPTIC_DEVICE_VERSION;
  sample.kind = HAPTIC_SAMPLE;
  sample.sequence = 1;
  sample.time_ns = kNow - 1000;
  sample.position[1] = 0.02;
  sample.orientation[0] = 1.0;
  sample.velocity[2] = -0.5;
  sample.buttons = 2;
  return sample;
}

std::variant<DeviceSample, haptic_refusal> read(const haptic_sample& sample, Conversation& conversation) {
  return read_sample(std::as_bytes(std::span(&sample, 1)), kNow, conversation);
}

haptic_refusal refusal_of(const std::function<void(haptic_sample&)>& spoil) {
  haptic_sample sample = good_sample();
  spoil(sample);
  Conversation conversation;
  const auto outcome = read(sample, conversation);
  const auto* const refusal = std::get_if<haptic_refusal>(&outcome);
  EXPECT_EQ(conversation.last_sequence, refusal == nullptr ? sample.sequence : 0U);
  return refusal == nullptr ? HAPTIC_NOT_REFUSED : *refusal;
}

TEST(ExternalProtocol, ReadsAGoodSample) {
  Conversation conversation;
  const auto outcome = read(good_sample(), conversation);
  const auto& sample = std::get<DeviceSample>(outcome);
  EXPECT_EQ(sample.time, kNow - 1000);
  EXPECT_EQ(sample.position, glm::dvec3(0.0, 0.02, 0.0));
  EXPECT_EQ(sample.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(sample.velocity, glm::dvec3(0.0, 0.0, -0.5));
  EXPECT_EQ(sample.buttons, 2U);
}

// Written by hand, so that a change of the layout is seen: offsets and bytes as the header tells them.
TEST(ExternalProtocol, TheLayoutIsLittleEndianAtTheOffsetsOfTheHeader) {
  std::array<unsigned char, 112> bytes{};
  const unsigned char head[] = {'H', 'A', 'P', 'D', 1, 0, 1, 0, 7};
  std::memcpy(bytes.data(), head, sizeof(head));
  bytes[16] = 9;                                       // time_ns
  bytes[24 + 6] = 0xE0, bytes[24 + 7] = 0x3F;          // position x: 0.5
  bytes[48 + 6] = 0xF0, bytes[48 + 7] = 0x3F;          // orientation w: 1
  bytes[80 + 8 + 6] = 0x00, bytes[80 + 8 + 7] = 0x40;  // velocity y: 2
  bytes[104] = 5;                                      // buttons
  Conversation conversation;
  const auto outcome = read_sample(std::as_bytes(std::span(bytes)), kNow, conversation);
  const auto& sample = std::get<DeviceSample>(outcome);
  EXPECT_EQ(conversation.last_sequence, 7U);
  EXPECT_EQ(sample.time, 9);
  EXPECT_EQ(sample.position.x, 0.5);
  EXPECT_EQ(sample.velocity.y, 2.0);
  EXPECT_EQ(sample.buttons, 5U);
}

TEST(ExternalProtocol, RefusesWhatIsNoSample) {
  EXPECT_EQ(refusal_of([](haptic_sample&) {}), HAPTIC_NOT_REFUSED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.magic ^= 1U; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.kind = HAPTIC_FORCE; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.reserved = 1; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.sequence = 0; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.time_ns = -1; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.position[2] = 1.1e6; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.orientation[0] = 0.0; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.orientation[0] = 1.01; }), HAPTIC_MALFORMED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.orientation[3] = 1e200; }), HAPTIC_MALFORMED);
}

TEST(ExternalProtocol, ASampleFromTheFutureIsRefusedAsItWouldNeverGrowOld) {
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.time_ns = kNow; }), HAPTIC_NOT_REFUSED);
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.time_ns = kNow + 1; }), HAPTIC_MALFORMED);
}

TEST(ExternalProtocol, SaysSoIfTheVersionIsAnotherWhateverTheSize) {
  EXPECT_EQ(refusal_of([](haptic_sample& s) { s.version = 2; }), HAPTIC_OTHER_VERSION);
  haptic_sample sample = good_sample();
  sample.version = 2;
  std::vector<std::byte> longer(200);
  std::memcpy(longer.data(), &sample, sizeof(sample));
  Conversation conversation;
  EXPECT_EQ(std::get<haptic_refusal>(read_sample(longer, kNow, conversation)), HAPTIC_OTHER_VERSION);
  EXPECT_EQ(std::get<haptic_refusal>(read_sample(std::span(longer).first(8), kNow, conversation)),
            HAPTIC_OTHER_VERSION);
}

TEST(ExternalProtocol, RefusesEverySizeButItsOwn) {
  const haptic_sample sample = good_sample();
  std::vector<std::byte> bytes(256);
  std::memcpy(bytes.data(), &sample, sizeof(sample));
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    Conversation conversation;
    const auto outcome = read_sample(std::span(bytes).first(size), kNow, conversation);
    EXPECT_EQ(std::holds_alternative<DeviceSample>(outcome), size == sizeof(sample)) << size;
  }
}

TEST(ExternalProtocol, SequenceAndTimeAscend) {
  Conversation conversation;
  haptic_sample sample = good_sample();
  sample.sequence = 5;
  ASSERT_TRUE(std::holds_alternative<DeviceSample>(read(sample, conversation)));
  EXPECT_TRUE(std::holds_alternative<haptic_refusal>(read(sample, conversation))) << "sent twice";
  sample.sequence = 9;  // some were lost
  sample.time_ns -= 1;
  EXPECT_TRUE(std::holds_alternative<haptic_refusal>(read(sample, conversation))) << "measured before";
  sample.time_ns += 1;
  EXPECT_TRUE(std::holds_alternative<DeviceSample>(read(sample, conversation)));
}

// The guard cuts force in the tick that sees it; a sample that is kept from it would have to grow old first.
TEST(ExternalProtocol, PassesOnANumberThatIsNone) {
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    haptic_sample sample = good_sample();
    sample.position[0] = wrong;
    sample.velocity[0] = wrong;
    Conversation conversation;
    const auto outcome = read(sample, conversation);
    EXPECT_FALSE(std::isfinite(std::get<DeviceSample>(outcome).position.x));
  }
  haptic_sample sample = good_sample();
  sample.orientation[2] = std::nan("");
  Conversation conversation;
  const auto outcome = read(sample, conversation);
  EXPECT_TRUE(std::isnan(std::get<DeviceSample>(outcome).orientation.y));
}

TEST(ExternalProtocol, NormalisesWhatSinglePrecisionHasLeft) {
  haptic_sample sample = good_sample();
  sample.orientation[0] = 0.70750, sample.orientation[1] = 0.70750;
  Conversation conversation;
  const auto outcome = read(sample, conversation);
  EXPECT_NEAR(glm::length(std::get<DeviceSample>(outcome).orientation), 1.0, 1e-15);
}

TEST(ExternalProtocol, AForceExpiresWithTheServosAndAfterThreeMillisecondsAtTheLatest) {
  const ForceCommand live{.expires = kNow + 1'000'000, .force = {1.0, 2.0, 3.0}, .torque = {4.0, 5.0, 6.0}};
  const haptic_force force = write_force(live, 8, kNow);
  EXPECT_EQ(force.magic, HAPTIC_DEVICE_MAGIC);
  EXPECT_EQ(force.version, HAPTIC_DEVICE_VERSION);
  EXPECT_EQ(force.kind, HAPTIC_FORCE);
  EXPECT_EQ(force.sequence, 8U);
  EXPECT_EQ(force.expires_ns, kNow + 1'000'000);
  EXPECT_EQ(force.force[1], 2.0);
  EXPECT_EQ(force.torque[2], 6.0);
  EXPECT_EQ(write_force({.expires = kNow + 30'000'000}, 8, kNow).expires_ns, kNow + 3'000'000);
}

TEST(ExternalProtocol, ARefusalHasNoForce) {
  const haptic_force message = write_refusal(HAPTIC_BUSY);
  EXPECT_EQ(message.kind, HAPTIC_REFUSED);
  EXPECT_EQ(message.refusal, HAPTIC_BUSY);
  for (const double component : message.force) EXPECT_EQ(component, 0.0);
}

}  // namespace
}  // namespace haptic::drivers::external
