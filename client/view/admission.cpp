#include "client/view/admission.h"

#include <array>

namespace haptic::gateway {
namespace {

struct Known {
  std::string_view name;
  Language language;
};

// the first of these that a client offers is taken
constexpr std::array kKnown = {Known{kHapticProtocol, Language::kHaptic},
                               Known{"foxglove.sdk.v1", Language::kFoxglove},
                               Known{"foxglove.websocket.v1", Language::kFoxglove}};

bool offers(std::string_view list, std::string_view name) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(','), list.size());
    std::string_view item = list.substr(0, end);
    while (!item.empty() && (item.front() == ' ' || item.front() == '\t')) {
      item.remove_prefix(1);
    }
    while (!item.empty() && (item.back() == ' ' || item.back() == '\t')) {
      item.remove_suffix(1);
    }
    if (item == name) {
      return true;
    }
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

std::optional<Rights> rights_of(const std::optional<std::string>& token, const HouseRules& rules) {
  if (token) {
    // both are always compared
    const bool drives = rules.tokens.drive && rules.tokens.drive->is(*token);
    const bool observes = rules.tokens.observe && rules.tokens.observe->is(*token);
    if (drives) {
      return Rights::kDrive;
    }
    return observes ? std::optional(Rights::kObserve) : std::nullopt;
  }
  if (rules.tokens.observe) {
    return std::nullopt;
  }
  return rules.anybody_drives ? Rights::kDrive : Rights::kObserve;
}

}  // namespace

std::variant<Target, Refusal> check_visit(const Visit& visit, const HouseRules& rules) {
  if (!visit.host) {
    return Refusal{400, "a request has one Host"};
  }
  if (!is_own_host(*visit.host, rules.hosts)) {
    return Refusal{421,
                   "this server is not called by that name; --allow-host of haptic-view tells more names"};
  }
  std::optional<Target> target = parse_target(visit.target);
  if (!target) {
    return Refusal{400, "there can be no such path here"};
  }
  return std::move(*target);
}

std::variant<Admission, Refusal> admit(const Visit& visit, const HouseRules& rules) {
  std::variant<Target, Refusal> checked = check_visit(visit, rules);
  if (auto* const refusal = std::get_if<Refusal>(&checked)) {
    return std::move(*refusal);
  }
  const Target& target = std::get<Target>(checked);
  if (target.path != "/ws" && target.path != "/index.html") {
    return Refusal{404, "the WebSocket is at /ws"};
  }
  if (visit.origin && !is_own_origin(*visit.origin, *visit.host, rules.origin)) {
    return Refusal{403,
                   "pages from elsewhere are not let in; --allow-origin of haptic-view tells exceptions"};
  }
  const std::optional<Rights> rights = rights_of(target.token, rules);
  if (!rights) {
    return Refusal{401, target.token ? "that token is not known here" : "a token is needed: /ws?token=..."};
  }
  for (const Known& known : kKnown) {
    if (offers(visit.subprotocols, known.name)) {
      return Admission{known.language, std::string(known.name), *rights};
    }
  }
  return Refusal{400, "offer one of the subprotocols haptic.v1, foxglove.sdk.v1, foxglove.websocket.v1"};
}

}  // namespace haptic::gateway
