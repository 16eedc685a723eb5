#include "client/bridge/subject.h"

#include <algorithm>

namespace haptic::bridge {
namespace {

// locales have no say in what a subject may hold
bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

bool is_port(std::string_view text) {
  if (text.empty() || text.size() > 5 ||
      !std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; })) {
    return false;
  }
  int port = 0;
  for (const char c : text) {
    port = 10 * port + (c - '0');
  }
  return port >= 1 && port <= 65535;
}

}  // namespace

std::string host_token(std::string_view host) {
  std::string token(host.substr(0, kHostLimit));
  std::replace_if(
      token.begin(), token.end(), [](char c) { return !is_plain(c); }, '_');
  return token;
}

std::string_view topic_name(v1::Topic topic) {
  switch (topic) {
    case v1::OBJECTS:
      return "objects";
    case v1::HIPS:
      return "hips";
    case v1::DEVICES:
      return "devices";
    case v1::EVENTS:
      return "events";
    case v1::STATS:
      return "stats";
    case v1::INPUTS:
      return "inputs";
    default:
      return {};
  }
}

std::string subject(std::string_view host, std::string_view last) {
  return "haptic." + host_token(host) + "." + std::string(last);
}

std::string url_problem(std::string_view url) {
  if (std::any_of(url.begin(), url.end(), [](char c) { return c <= ' ' || c > '~' || c == ','; })) {
    return "it has a character that no URL has";
  }
  if (const std::size_t end = url.find("://"); end != std::string_view::npos) {
    const std::string_view scheme = url.substr(0, end);
    if (scheme != "nats" && scheme != "tls") {
      return "its scheme is neither nats nor tls";
    }
    url.remove_prefix(end + 3);
  }
  if (const std::size_t at = url.rfind('@'); at != std::string_view::npos) {
    url.remove_prefix(at + 1);
  }
  const bool bracketed = url.starts_with('[');
  const std::size_t host_end = bracketed ? url.find(']') : url.find(':');
  if (bracketed && host_end == std::string_view::npos) {
    return "its bracket is not closed";
  }
  const std::string_view host = bracketed ? url.substr(1, host_end - 1) : url.substr(0, host_end);
  if (host.empty()) {
    return "it has no host";
  }
  if (host.find_first_of("/?#[]") != std::string_view::npos) {
    return "it has more than host and port";
  }
  const std::string_view rest =
      host_end == std::string_view::npos ? std::string_view() : url.substr(host_end + (bracketed ? 1 : 0));
  if (!rest.empty() && (!rest.starts_with(':') || !is_port(rest.substr(1)))) {
    return "its port is no number from 1 to 65535";
  }
  return {};
}

std::string without_secrets(std::string_view url) {
  const std::size_t scheme = url.find("://");
  const std::size_t begin = scheme == std::string_view::npos ? 0 : scheme + 3;
  const std::size_t at = url.rfind('@');
  if (at == std::string_view::npos || at < begin) {
    return std::string(url);
  }
  return std::string(url.substr(0, begin)) + std::string(url.substr(at + 1));
}

}  // namespace haptic::bridge
