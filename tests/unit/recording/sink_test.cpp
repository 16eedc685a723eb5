#include "proto/recording/sink.h"

#include <gtest/gtest.h>

#include "proto/recording/error.h"
#include "proto/recording/source.h"
#include "tests/support/temporary_folder.h"

namespace haptic::recording {
namespace {

std::string what_of(const auto& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(FileSink, WritesAndGoesOnWhereItWasCut) {
  const test::TemporaryFolder folder;
  FileSink sink(folder.file("a.mcap"), FileSink::IfThere::kRefuse, FileSink::Durable::kYes);
  sink.write("hello world");
  sink.truncate(5);
  sink.write(", you");
  sink.sync();
  sink.close();
  EXPECT_EQ(folder.read("a.mcap"), "hello, you");
}

TEST(FileSink, KeepsAFileThatIsThereUnlessToldToReplaceIt) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("a.mcap", "precious");
  EXPECT_TRUE(contains(
      what_of([&] { FileSink sink(path, FileSink::IfThere::kRefuse, FileSink::Durable::kNo); }), path));
  EXPECT_EQ(folder.read("a.mcap"), "precious");
  FileSink sink(path, FileSink::IfThere::kReplace, FileSink::Durable::kNo);
  EXPECT_EQ(folder.read("a.mcap"), "");
}

TEST(FileSink, NamesTheFileAndTheReasonWhenTheDiskIsFull) {
  FileSink sink("/dev/full", FileSink::IfThere::kReplace, FileSink::Durable::kNo);
  EXPECT_EQ(what_of([&] { sink.write("x"); }), "/dev/full: cannot be written: No space left on device");
}

TEST(FileSource, ReadsBytesAtOffsetsAndNoneBeyondTheEnd) {
  const test::TemporaryFolder folder;
  const FileSource source(folder.write("a.mcap", "0123456789"));
  std::string bytes;
  EXPECT_EQ(source.size(), 10U);
  source.read(3, 4, bytes);
  EXPECT_EQ(bytes, "3456");
  EXPECT_THROW(source.read(8, 3, bytes), FormatError);
  EXPECT_THROW(source.read(~std::uint64_t{0}, 3, bytes), FormatError);
}

TEST(FileSource, TellsWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(contains(what_of([&] { FileSource source(folder.file("none")); }), "No such file"));
  EXPECT_TRUE(contains(what_of([&] { FileSource source("/dev/null"); }), "no regular file"));
}

}  // namespace
}  // namespace haptic::recording
