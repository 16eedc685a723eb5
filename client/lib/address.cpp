#include "client/lib/address.h"

#include <arpa/inet.h>

#include <array>

#include "proto/socket_path.h"

namespace haptic::client {

Address parse_address(const std::string& text) {
  if (text.empty()) {
    return {proto::client_socket_path(), "", ""};
  }
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || text.find('/') != std::string::npos) {
    return {text, "", ""};
  }
  std::string host = text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  return {"", host, text.substr(colon + 1)};
}

std::string to_string(const Address& address) {
  if (!address.path.empty()) {
    return address.path;
  }
  const bool is_ipv6 = address.host.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + address.host + "]" : address.host) + ":" + address.port;
}

bool is_ip(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> ignored{};
  return ::inet_pton(AF_INET, host.c_str(), ignored.data()) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), ignored.data()) == 1;
}

}  // namespace haptic::client
