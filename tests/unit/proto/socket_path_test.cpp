#include "proto/socket_path.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

namespace haptic::proto {
namespace {

TEST(SocketPath, IsWhatTheEnvironmentNames) {
  ::setenv("HAPTICD_SOCKET", "/somewhere/else.sock", 1);
  EXPECT_EQ(client_socket_path(), "/somewhere/else.sock");
  ::unsetenv("HAPTICD_SOCKET");
}

TEST(SocketPath, OfAnOrdinaryUserIsInTheRuntimeDirectory) {
  ::setenv("XDG_RUNTIME_DIR", "/run/user/77", 1);
  EXPECT_EQ(user_socket_directory(), "/run/user/77/hapticd");
}

TEST(SocketPath, WithoutARuntimeDirectoryIsInAPrivateOne) {
  ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_EQ(user_socket_directory(), "/tmp/hapticd-" + std::to_string(::getuid()));
}

}  // namespace
}  // namespace haptic::proto
