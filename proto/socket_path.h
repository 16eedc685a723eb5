#pragma once
// Where the daemon's Unix socket is when nobody says: the one rule, for the daemon and its clients.
//
//     HAPTICD_SOCKET                        if it is set
//     /run/hapticd/hapticd.sock             of the system service
//     $XDG_RUNTIME_DIR/hapticd/hapticd.sock of an ordinary user's daemon
//     /tmp/hapticd-UID/hapticd.sock         where there is no XDG_RUNTIME_DIR

#include <string>

namespace haptic::proto {

inline constexpr const char* kServiceSocket = "/run/hapticd/hapticd.sock";

/// The directory of an ordinary user's socket. It may not exist.
std::string user_socket_directory();

/// Where a client looks: HAPTICD_SOCKET, else the service's socket if there is one, else the user's.
std::string client_socket_path();

}  // namespace haptic::proto
