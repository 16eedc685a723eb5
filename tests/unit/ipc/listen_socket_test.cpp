#include "ipc/listen_socket.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <fstream>
#include <functional>

#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

v1::Listen::Unix at(const std::string& path) {
  v1::Listen::Unix config;
  config.set_path(path);
  return config;
}

std::string error_of(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const ListenError& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// a socket that listens without any lock, as another program's would
int foreign_socket(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof(name.sun_path) - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  EXPECT_EQ(::listen(socket, 1), 0);
  return socket;
}

class UnixListenerTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::string path_ = folder_.file("hapticd.sock");
};

TEST_F(UnixListenerTest, RefusesASecondDaemonInWords) {
  const UnixListener first(at(path_));
  const std::string error = error_of([&] { const UnixListener second(at(path_)); });
  EXPECT_TRUE(contains(error, "another hapticd listens on " + path_)) << error;
  EXPECT_EQ(::access(path_.c_str(), F_OK), 0);  // the first one still has its socket
}

TEST_F(UnixListenerTest, RefusesAPathWhereAnotherProgramListens) {
  const int foreign = foreign_socket(path_);
  const std::string error = error_of([&] { const UnixListener listener(at(path_)); });
  EXPECT_TRUE(contains(error, "another program listens on")) << error;
  EXPECT_EQ(::access(path_.c_str(), F_OK), 0);
  ::close(foreign);
}

TEST_F(UnixListenerTest, TakesTheSocketOfADeadDaemon) {
  ::close(foreign_socket(path_));  // the file stays
  ASSERT_EQ(::access(path_.c_str(), F_OK), 0);
  const UnixListener listener(at(path_));
  EXPECT_EQ(::access(path_.c_str(), F_OK), 0);
}

TEST_F(UnixListenerTest, LeavesAFileThatIsNoSocketAlone) {
  std::ofstream(path_) << "precious";
  const std::string error = error_of([&] { const UnixListener listener(at(path_)); });
  EXPECT_TRUE(contains(error, "is no socket")) << error;
  EXPECT_EQ(std::filesystem::file_size(path_), 8U);
}

TEST_F(UnixListenerTest, NamesADirectoryThatIsNotThere) {
  const std::string error =
      error_of([&] { const UnixListener listener(at(folder_.file("not/there.sock"))); });
  EXPECT_TRUE(contains(error, "there is no directory " + folder_.file("not"))) << error;
}

TEST_F(UnixListenerTest, RefusesAPathThatIsTooLong) {
  const std::string error = error_of([&] { const UnixListener listener(at("/" + std::string(200, 'x'))); });
  EXPECT_TRUE(contains(error, "has 1 to 107 bytes")) << error;
}

TEST_F(UnixListenerTest, LetsOwnerAndGroupInButNobodyElse) {
  const UnixListener listener(at(path_));
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0660U);
}

TEST_F(UnixListenerTest, AdmitsTheGroupsOfTheConfigByAccessList) {
  v1::Listen::Unix config = at(path_);
  for (const char* group : {"daemon", "sys"}) {
    config.add_allow()->set_group(group);
    config.mutable_allow()->rbegin()->set_role(v1::OBSERVE);
  }
  const UnixListener listener(config);
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0007U, 0U);
  const ssize_t size = ::getxattr(path_.c_str(), "system.posix_acl_access", nullptr, 0);
  if (size < 0) {
    GTEST_SKIP() << "/tmp has no access lists";
  }
  // 4 bytes of version, 8 for each of: owner, group, two named groups, mask, others
  EXPECT_EQ(size, 4 + 6 * 8);
}

TEST_F(UnixListenerTest, RemovesItsSocketInTheEnd) {
  { const UnixListener listener(at(path_)); }
  EXPECT_NE(::access(path_.c_str(), F_OK), 0);
  const UnixListener again(at(path_));
}

TEST_F(UnixListenerTest, TakesThePassedSocketOfItsPathAndLeavesTheFileToTheManager) {
  ASSERT_EQ(::chmod(folder_.file("").c_str(), 0755), 0);
  const int passed = foreign_socket(path_);
  ASSERT_EQ(::chmod(path_.c_str(), 0600), 0);
  {
    UnixListener listener(at(path_), Descriptor(passed));
    EXPECT_EQ(listener.path(), path_);
    EXPECT_EQ(listener.release(), passed);
    ::close(passed);
  }
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);  // no file is removed, and its mode is the manager's
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  EXPECT_NE(::access((path_ + ".lock").c_str(), F_OK), 0);
}

TEST_F(UnixListenerTest, AdmitsOtherGroupsLater) {
  UnixListener listener(at(path_));
  const auto entries = [&] { return ::getxattr(path_.c_str(), "system.posix_acl_access", nullptr, 0); };
  listener.admit(Authoriser(::geteuid(), {{1, v1::OBSERVE}}));
  if (entries() < 0) {
    GTEST_SKIP() << "/tmp has no access lists";
  }
  EXPECT_EQ(entries(), 4 + 5 * 8);
  listener.admit(Authoriser(::geteuid(), {{1, v1::OBSERVE}, {3, v1::DRIVE}}));
  EXPECT_EQ(entries(), 4 + 6 * 8);
  listener.admit(Authoriser(::geteuid(), {}));
  EXPECT_LT(entries(), 0);
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0660U);
}

TEST_F(UnixListenerTest, RefusesAPassedDescriptorThatIsNoListeningUnixSocketInWords) {
  const int file = ::open(folder_.write("file", "").c_str(), O_RDONLY);
  EXPECT_TRUE(contains(error_of([&] { path_of_passed(file); }), "is no stream socket that listens"));
  ::close(file);
  const int silent = ::socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT_TRUE(contains(error_of([&] { path_of_passed(silent); }), "is no stream socket that listens"));
  ::close(silent);
  v1::Listen::Tcp loopback;
  loopback.set_address("127.0.0.1");
  const int tcp = listen_tcp(loopback);
  EXPECT_TRUE(contains(error_of([&] { path_of_passed(tcp); }), "is no Unix socket with a path"));
  ::close(tcp);
}

TEST(DefaultSocketPath, IsMadePrivateWhereThereIsNoRuntimeDirectory) {
  const test::TemporaryFolder folder;
  ::unsetenv("HAPTICD_SOCKET");
  ::unsetenv("RUNTIME_DIRECTORY");
  ::setenv("XDG_RUNTIME_DIR", folder.file("").c_str(), 1);
  EXPECT_EQ(default_socket_path(), folder.file("") + "/hapticd/hapticd.sock");
  struct stat status {};
  ASSERT_EQ(::stat(folder.file("hapticd").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0700U);

  ASSERT_EQ(::chmod(folder.file("hapticd").c_str(), 0777), 0);
  EXPECT_THROW(default_socket_path(), ListenError);
  ::unsetenv("XDG_RUNTIME_DIR");
}

TEST(ListenTcp, ListensOnLoopbackOnly) {
  v1::Listen::Tcp config;
  for (const char* address : {"0.0.0.0", "192.168.1.1", "::", "2001:db8::1"}) {
    config.set_address(address);
    const std::string error = error_of([&] { ::close(listen_tcp(config)); });
    EXPECT_TRUE(contains(error, "is not loopback")) << error;
  }
  config.set_address("localhost");
  EXPECT_TRUE(contains(error_of([&] { ::close(listen_tcp(config)); }), "is no IPv4 or IPv6 address"));
  config.set_address("127.0.0.1");
  EXPECT_EQ(error_of([&] { ::close(listen_tcp(config)); }), "no error");
  config.set_port(65536);
  EXPECT_TRUE(contains(error_of([&] { ::close(listen_tcp(config)); }), "is not in 0 to 65535"));
}

}  // namespace
}  // namespace haptic::ipc
