#include "load/read_file.h"

#include <sys/stat.h>

#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

TEST(ReadFile, ReturnsEveryByte) {
  const TemporaryFolder folder;
  std::string bytes(100000, 'a');
  bytes[50] = '\0';
  EXPECT_EQ(read_file(folder.write("f", bytes), bytes.size()), bytes);
  EXPECT_EQ(read_file(folder.write("empty", ""), 0), "");
}

TEST(ReadFile, RefusesAFileThatIsTooLargeBeforeReadingIt) {
  const TemporaryFolder folder;
  // sparse: reading it would take a terabyte
  const auto file = folder.write("large", "");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40U);
  const LoadError error = error_of([&] { read_file(file, 1000); });
  EXPECT_EQ(error.file(), file.string());
  EXPECT_NE(std::string(error.what()).find("permitted: up to 1000 bytes"), std::string::npos);
}

TEST(ReadFile, BoundsAFileThatHidesItsSize) {
  // the kernel says 0 bytes for files that it makes while they are read
  EXPECT_FALSE(read_file("/proc/self/status", 1U << 20U).empty());
  error_of([] { read_file("/proc/self/status", 10); });
}

TEST(ReadFile, RefusesWhatIsNoRegularFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of([&] { read_file(folder.path(), 10); }).message(), "is a directory, not a file");
  EXPECT_EQ(error_of([] { read_file("/dev/zero", 10); }).message(), "is not a regular file");
  EXPECT_EQ(error_of([&] { read_file(folder.path() / "none", 10); }).message(),
            "cannot be opened: No such file or directory");
}

TEST(ReadFile, DoesNotWaitForAPipe) {
  const TemporaryFolder folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(error_of([&] { read_file(pipe, 10); }).message(), "is not a regular file");
}

TEST(RelativeTo, IsTheFolderOfTheFileThatNamesIt) {
  EXPECT_EQ(relative_to("/etc/hapticd/a.txtpb", "paths/b.csv"), "/etc/hapticd/paths/b.csv");
  EXPECT_EQ(relative_to("/etc/hapticd/a.txtpb", "../b.csv"), "/etc/b.csv");
  EXPECT_EQ(relative_to("/etc/hapticd/a.txtpb", "/b.csv"), "/b.csv");
  EXPECT_EQ(relative_to("a.txtpb", "b.csv"), "b.csv");
}

TEST(InQuotes, EscapesWhatDoesNotPrintAndCutsWhatIsLong) {
  EXPECT_EQ(in_quotes("wood"), "\"wood\"");
  EXPECT_EQ(in_quotes("a\n\x1b"), "\"a\\x0a\\x1b\"");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "\"" + std::string(60, 'x') + "...\"");
}

}  // namespace
}  // namespace haptic::load
