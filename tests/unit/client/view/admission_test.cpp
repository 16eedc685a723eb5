#include "client/view/admission.h"

#include <gtest/gtest.h>

namespace haptic::gateway {
namespace {

constexpr std::string_view kWatcher = "token-of-a-watcher";
constexpr std::string_view kDriver = "token-of-a-driver-";

Visit visit_with(std::string_view target) {
  return {.target = target,
          .host = "127.0.0.1:8765",
          .origin = "http://127.0.0.1:8765",
          .subprotocols = kHapticProtocol};
}

unsigned status_of(const Visit& visit, const HouseRules& rules) {
  const auto verdict = admit(visit, rules);
  const auto* const refusal = std::get_if<Refusal>(&verdict);
  return refusal == nullptr ? 101 : refusal->status;
}

std::optional<Rights> rights_of(std::string_view target, const HouseRules& rules) {
  const auto verdict = admit(visit_with(target), rules);
  const auto* const admission = std::get_if<Admission>(&verdict);
  return admission == nullptr ? std::nullopt : std::optional(admission->rights);
}

HouseRules with_tokens() {
  HouseRules rules;
  rules.tokens = {.observe = Token(kWatcher), .drive = Token(kDriver)};
  return rules;
}

TEST(Admission, LetsAPageOfOursObserve) { EXPECT_EQ(rights_of("/ws", HouseRules()), Rights::kObserve); }

TEST(Admission, LetsAProgramInThatIsNoBrowserAndHasNoOrigin) {
  Visit visit = visit_with("/ws");
  visit.origin.reset();
  EXPECT_EQ(status_of(visit, HouseRules()), 101U);
}

TEST(Admission, RefusesAPageFromElsewhere) {
  Visit visit = visit_with("/ws");
  visit.origin = "http://evil.example";
  EXPECT_EQ(status_of(visit, HouseRules()), 403U);
  HouseRules rules;
  rules.origin.allowed = {"http://evil.example"};
  EXPECT_EQ(status_of(visit, rules), 101U);
}

TEST(Admission, RefusesANameThatIsNotOurs) {
  Visit visit = visit_with("/ws");
  visit.host = "rebound.example:8765";
  visit.origin = "http://rebound.example:8765";
  EXPECT_EQ(status_of(visit, HouseRules()), 421U);
  EXPECT_TRUE(std::holds_alternative<Refusal>(check_visit(visit, HouseRules())));
  visit.host.reset();
  EXPECT_EQ(status_of(visit, HouseRules()), 400U);
}

TEST(Admission, RefusesWhoOffersNoSubprotocolThatIsKnown) {
  for (const char* const list : {"", "chat", "haptic.v2", "haptic.v1x", "HAPTIC.V1", ",", "chat, mqtt"}) {
    Visit visit = visit_with("/ws");
    visit.subprotocols = list;
    EXPECT_EQ(status_of(visit, HouseRules()), 400U) << list;
  }
}

TEST(Admission, TakesOneOfTheSubprotocolsThatAreOffered) {
  const auto chosen = [](std::string_view list) {
    Visit visit = visit_with("/ws");
    visit.subprotocols = list;
    return std::get<Admission>(admit(visit, HouseRules()));
  };
  EXPECT_EQ(chosen("foxglove.websocket.v1").subprotocol, "foxglove.websocket.v1");
  EXPECT_EQ(chosen("foxglove.websocket.v1, foxglove.sdk.v1").subprotocol, "foxglove.sdk.v1");
  EXPECT_EQ(chosen("chat,\tfoxglove.sdk.v1 ").language, Language::kFoxglove);
  EXPECT_EQ(chosen("haptic.v1").language, Language::kHaptic);
}

TEST(Admission, IsAtOnePlaceAndAtTheRootForViewersWithoutAPath) {
  EXPECT_EQ(rights_of("/", HouseRules()), Rights::kObserve);
  EXPECT_EQ(status_of(visit_with("/other"), HouseRules()), 404U);
  EXPECT_EQ(status_of(visit_with("/../ws"), HouseRules()), 400U);
}

TEST(Admission, WithTokensTakesNobodyWithoutOne) {
  const HouseRules rules = with_tokens();
  EXPECT_EQ(status_of(visit_with("/ws"), rules), 401U);
  EXPECT_EQ(status_of(visit_with("/ws?token="), rules), 401U);
  EXPECT_EQ(status_of(visit_with("/ws?token=token-of-nobody-here"), rules), 401U);
  EXPECT_EQ(rights_of("/ws?token=" + std::string(kWatcher), rules), Rights::kObserve);
  EXPECT_EQ(rights_of("/ws?token=" + std::string(kDriver), rules), Rights::kDrive);
}

TEST(Admission, WithADriversTokenAloneLetsAnybodyObserve) {
  HouseRules rules;
  rules.tokens.drive = Token(kDriver);
  EXPECT_EQ(rights_of("/ws", rules), Rights::kObserve);
  EXPECT_EQ(rights_of("/ws?token=" + std::string(kDriver), rules), Rights::kDrive);
  EXPECT_EQ(status_of(visit_with("/ws?token=" + std::string(kWatcher)), rules), 401U);
}

TEST(Admission, LetsEverybodyDriveOnlyIfItIsToldTo) {
  HouseRules rules;
  rules.anybody_drives = true;
  EXPECT_EQ(rights_of("/ws", rules), Rights::kDrive);
  Visit visit = visit_with("/ws");
  visit.origin = "http://evil.example";
  EXPECT_EQ(status_of(visit, rules), 403U);
}

TEST(Admission, RefusesATokenWhereNoneIsKnown) {
  EXPECT_EQ(status_of(visit_with("/ws?token=token-of-somebody"), HouseRules()), 401U);
}

}  // namespace
}  // namespace haptic::gateway
