#include "proto/socket_path.h"

#include <unistd.h>

#include <cstdlib>

namespace haptic::proto {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

}  // namespace

std::string user_socket_directory() {
  const std::string runtime = variable("XDG_RUNTIME_DIR");
  return runtime.empty() ? "/tmp/hapticd-" + std::to_string(::getuid()) : runtime + "/hapticd";
}

std::string client_socket_path() {
  if (std::string path = variable("HAPTICD_SOCKET"); !path.empty()) {
    return path;
  }
  if (::access(kServiceSocket, F_OK) == 0) {
    return kServiceSocket;
  }
  return user_socket_directory() + "/hapticd.sock";
}

}  // namespace haptic::proto
