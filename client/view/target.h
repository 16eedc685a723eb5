#pragma once
// What stands after GET: a path and a query. Pure.

#include <optional>
#include <string>
#include <string_view>

namespace haptic::gateway {

struct Target {
  std::string path;                  // decoded; begins with a slash
  std::optional<std::string> token;  // of the query's "token", decoded
};

/// Nothing if it is no path that this server has files for: it must begin with one slash, be encoded rightly,
/// and none of its parts may be empty, begin with a dot or hold a slash, a backslash or a control character
/// in disguise. Nor if the query has two tokens. A slash at the end stands for index.html.
std::optional<Target> parse_target(std::string_view text);

/// The part with each %XX replaced by its byte; nothing if a % is followed by anything else.
std::optional<std::string> percent_decoded(std::string_view text);

}  // namespace haptic::gateway
