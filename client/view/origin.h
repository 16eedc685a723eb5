#pragma once
// Whether the page that asks is one of ours. A browser tells in Host by which name it came, and in Origin
// from which page. Other programs can tell what they like: these checks protect people, not secrets. Pure.
//
//     Host    an IP address, localhost, or a name that --allow-host tells: a name of somebody else's that
//             leads here (DNS rebinding) is refused
//     Origin  the same scheme and host, or one that --allow-origin tells; a program that is no browser has
//             none

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptic::gateway {

/// A host's name, or an IP address without brackets, of "HOST[:PORT]" in small letters; nothing if that is
/// not what it is.
std::optional<std::string> host_name(std::string_view host);

/// `allowed`: names, in small letters.
bool is_own_host(std::string_view host, const std::vector<std::string>& allowed);

struct OriginRule {
  bool tls = false;                  // how this server is reached
  std::vector<std::string> allowed;  // further origins, "https://app.example:8080"
};

/// `host`: what is_own_host() is true of.
bool is_own_origin(std::string_view origin, std::string_view host, const OriginRule& rule);

/// What is wrong with an origin that a person allows; empty if nothing is.
std::string origin_problem(std::string_view origin);

}  // namespace haptic::gateway
