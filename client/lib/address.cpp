#include "client/lib/address.h"

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

}  // namespace haptic::client
