#pragma once
// Where a daemon is: a Unix socket's path, or host and port.

#include <string>

namespace haptic::client {

struct Address {
  std::string path;  // of a Unix socket; empty: TCP
  std::string host;
  std::string port;
};

/// "" is the default place (proto/socket_path.h), what has a slash or no colon is a path, and the rest is
/// host:port with an IPv6 address in brackets.
Address parse_address(const std::string& text);

/// As parse_address reads it.
std::string to_string(const Address& address);

/// Whether a host is told by its IP address, not by its name.
bool is_ip(const std::string& host);

}  // namespace haptic::client
