// The schema of today against those of the releases, which it may only add to.

#include <google/protobuf/compiler/importer.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "haptic/v1/control.pb.h"
#include "tests/compatibility/breaking_changes.h"
#include "tests/compatibility/releases.h"
#include "tests/support/places.h"

namespace haptic::test {
namespace {

class FrozenSchema : public testing::TestWithParam<std::string> {};

TEST_P(FrozenSchema, IsOnlyAddedTo) {
  const std::filesystem::path folder =
      std::filesystem::path(test::source_dir()) / "tests/compatibility" / GetParam();
  google::protobuf::compiler::DiskSourceTree tree;
  tree.MapPath("", folder.string());
  google::protobuf::compiler::Importer importer(&tree, nullptr);
  // the envelope reaches all other files, of today's schema as well
  ASSERT_NE(v1::Envelope::descriptor(), nullptr);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "haptic/v1")) {
    const auto* file = importer.Import("haptic/v1/" + entry.path().filename().string());
    ASSERT_NE(file, nullptr) << entry.path();
    ++files;
    for (const std::string& change :
         breaking_changes(*file, *google::protobuf::DescriptorPool::generated_pool())) {
      ADD_FAILURE() << "since " << GetParam() << ": " << change;
    }
  }
  EXPECT_GE(files, 6);
}

INSTANTIATE_TEST_SUITE_P(Releases, FrozenSchema, testing::ValuesIn(frozen_releases()),
                         [](const auto& release) { return release.param; });

}  // namespace
}  // namespace haptic::test
