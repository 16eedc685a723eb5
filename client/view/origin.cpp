#include "client/view/origin.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>

namespace haptic::gateway {
namespace {

std::string small(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_letter_of_names(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_';
}

bool is_address(const std::string& name) {
  boost::system::error_code error;
  boost::asio::ip::make_address(name, error);
  return !error;
}

}  // namespace

std::optional<std::string> host_name(std::string_view host) {
  const bool bracketed = host.starts_with('[');
  const std::size_t end = std::min(bracketed ? host.find(']') : host.find(':'), host.size());
  if (bracketed && end == host.size()) {
    return std::nullopt;
  }
  const std::string_view rest = host.substr(end + (bracketed ? 1U : 0U));
  if (!rest.empty() && (!rest.starts_with(':') || !is_port(rest.substr(1)))) {
    return std::nullopt;
  }
  const std::string name = small(host.substr(bracketed ? 1 : 0, bracketed ? end - 1 : end));
  const bool is_right = bracketed ? is_address(name) && name.find(':') != std::string::npos
                                  : std::all_of(name.begin(), name.end(), is_letter_of_names);
  return name.empty() || !is_right ? std::nullopt : std::optional(name);
}

bool is_own_host(std::string_view host, const std::vector<std::string>& allowed) {
  const std::optional<std::string> name = host_name(host);
  return name && (*name == "localhost" || is_address(*name) ||
                  std::find(allowed.begin(), allowed.end(), *name) != allowed.end());
}

bool is_own_origin(std::string_view origin, std::string_view host, const OriginRule& rule) {
  const std::string shown = small(origin);
  return shown == (rule.tls ? "https://" : "http://") + small(host) ||
         std::any_of(rule.allowed.begin(), rule.allowed.end(),
                     [&](const std::string& other) { return small(other) == shown; });
}

std::string origin_problem(std::string_view origin) {
  const std::size_t scheme = origin.find("://");
  if (scheme == std::string_view::npos || scheme == 0) {
    return "an origin is SCHEME://HOST[:PORT]";
  }
  return host_name(origin.substr(scheme + 3)) ? "" : "an origin ends with its host and port";
}

}  // namespace haptic::gateway
