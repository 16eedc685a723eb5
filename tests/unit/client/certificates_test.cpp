#include "client/lib/certificates.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "client/lib/error.h"
#include "tests/support/temporary_folder.h"

namespace haptic::client {
namespace {

unsigned mode_of(const std::filesystem::path& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0) << path;
  return status.st_mode & 0777U;
}

TEST(Certificates, KeepKeysFromOthers) {
  const test::TemporaryFolder folder;
  const auto files =
      make_certificates({folder.file("lab"), {"lab.example", "10.0.0.7", "fe80::1"}, {"alice"}});
  ASSERT_EQ(files.size(), 6U);
  EXPECT_EQ(mode_of(folder.file("lab")), 0700U);
  for (const auto& file : files) {
    EXPECT_EQ(mode_of(file) & 0077U, file.extension() == ".key" ? 0U : mode_of(file) & 0044U) << file;
  }
  EXPECT_EQ(files[4], folder.file("lab/alice.crt"));
}

TEST(Certificates, OverwriteNothingAndThenWriteNothing) {
  const test::TemporaryFolder folder;
  folder.write("bob.key", "precious");
  EXPECT_THROW(make_certificates({folder.file("."), {"lab"}, {"alice", "bob"}}), Error);
  EXPECT_EQ(folder.read("bob.key"), "precious");
  EXPECT_FALSE(std::filesystem::exists(folder.file("authority.crt")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("alice.crt")));
}

TEST(Certificates, TakeNoNameThatCouldMeanMore) {
  const test::TemporaryFolder folder;
  for (const char* name :
       {"", ".", "..", "../up", "a/b", "a b", "a,DNS:evil", "server", "authority", "-rf"}) {
    EXPECT_THROW(make_certificates({folder.file("lab"), {"lab"}, {name}}), Invalid) << name;
  }
  EXPECT_THROW(make_certificates({folder.file("lab"), {"lab"}, {"alice", "alice"}}), Invalid);
  EXPECT_THROW(make_certificates({folder.file("lab"), {"lab,IP:1.2.3.4"}, {}}), Invalid);
  EXPECT_THROW(make_certificates({folder.file("lab"), {}, {}}), Invalid);
  EXPECT_FALSE(std::filesystem::exists(folder.file("lab")));
}

}  // namespace
}  // namespace haptic::client
