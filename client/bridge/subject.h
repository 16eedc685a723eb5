#pragma once
// The names under which a bridge publishes:
//
//     haptic.HOST.objects|hips|devices|events|stats    Frame, one subject for each topic
//     haptic.HOST.gap                                  Gap
//     haptic.HOST.scene                                SceneDescription
//     haptic.HOST.status                               BridgeStatus
//     haptic.HOST.scene.get, haptic.HOST.status.get    requests, answered with the same messages

#include <string>
#include <string_view>

#include "haptic/v1/control.pb.h"

namespace haptic::bridge {

/// The longest host in a subject, bytes; that of a host's name.
inline constexpr std::size_t kHostLimit = 253;

/// A host's name as one token of a subject: each byte outside A-Z a-z 0-9 _ - becomes an underscore, since a
/// broker reads dots, blanks and wildcards as more than letters. Empty for an empty name.
std::string host_token(std::string_view host);

/// "objects", "hips", "devices", "events", "stats"; empty for any other.
std::string_view topic_name(v1::Topic topic);

/// "haptic.HOST.LAST"; the host is made a token.
std::string subject(std::string_view host, std::string_view last);

/// What is wrong with the URL of a broker, for a person; empty if nothing is. Right is
/// [SCHEME://][USER[:PASSWORD]@]HOST[:PORT] with the scheme nats or tls, and an IPv6 address in brackets.
std::string url_problem(std::string_view url);

/// The URL without user and password, for logs.
std::string without_secrets(std::string_view url);

}  // namespace haptic::bridge
