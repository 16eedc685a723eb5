// The head of an HTTP request: target, host, origin and subprotocols, one a line. Whatever comes: nobody who
// shows no token is let in where one is needed, nobody from elsewhere comes in, and no path leads out of the
// page's folder.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "client/view/admission.h"

namespace {

using namespace haptic::gateway;

const HouseRules& open_house() {
  static const HouseRules kRules;
  return kRules;
}

const HouseRules& locked_house() {
  static const HouseRules kRules = [] {
    HouseRules rules;
    rules.tokens = {.observe = Token("token-of-a-watcher"), .drive = Token("token-of-a-driver-")};
    return rules;
  }();
  return kRules;
}

bool is_inside(std::string_view path) {
  return path.starts_with('/') && path.find("/.") == std::string_view::npos &&
         path.find("//") == std::string_view::npos && path.find('\0') == std::string_view::npos &&
         path.find('\\') == std::string_view::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::array<std::string_view, 4> line;
  for (std::string_view& part : line) {
    part = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
  }
  Visit visit{.target = line[0], .host = line[1], .origin = std::nullopt, .subprotocols = line[3]};
  if (!line[2].empty()) {
    visit.origin = line[2];
  }
  const auto checked = check_visit(visit, open_house());
  if (const auto* const target = std::get_if<Target>(&checked);
      target != nullptr && !is_inside(target->path)) {
    std::abort();
  }
  const auto open = admit(visit, open_house());
  const auto locked = admit(visit, locked_house());
  if (const auto* const admission = std::get_if<Admission>(&open)) {
    if (admission->rights != Rights::kObserve) std::abort();
    if (visit.origin && !is_own_origin(*visit.origin, *visit.host, {})) std::abort();
    if (line[3].find(admission->subprotocol) == std::string_view::npos) std::abort();
  }
  if (std::holds_alternative<Admission>(locked) && line[0].find("token=") == std::string_view::npos) {
    std::abort();
  }
  return 0;
}
