#pragma once
// Who comes in, and what he may do: every request passes here before anything else. Pure.

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "client/view/origin.h"
#include "client/view/target.h"
#include "client/view/token.h"

namespace haptic::gateway {

inline constexpr std::string_view kHapticProtocol = "haptic.v1";

enum class Rights { kObserve, kDrive };
enum class Language { kHaptic, kFoxglove };

struct HouseRules {
  std::vector<std::string> hosts;  // names that this server is called by
  OriginRule origin;
  Tokens tokens;
  bool anybody_drives = false;  // without a token
};

/// Of an HTTP request what counts here. A header that comes twice makes it wrong before.
struct Visit {
  std::string_view target;
  std::optional<std::string_view> host;
  std::optional<std::string_view> origin;
  std::string_view subprotocols;  // comma separated
};

struct Refusal {
  unsigned status = 0;  // of HTTP
  std::string reason;   // for a person
};

struct Admission {
  Language language = Language::kHaptic;
  std::string subprotocol;  // as the client offered it
  Rights rights = Rights::kObserve;
};

/// For anything at all: the target, or why not.
std::variant<Target, Refusal> check_visit(const Visit& visit, const HouseRules& rules);

/// For a WebSocket, at /ws or, as viewers of Foxglove's kind have no path, at /.
std::variant<Admission, Refusal> admit(const Visit& visit, const HouseRules& rules);

}  // namespace haptic::gateway
