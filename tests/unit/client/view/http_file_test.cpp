#include "client/view/http_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace haptic::gateway {
namespace {

namespace fs = std::filesystem;

class HttpFile : public testing::Test {
 protected:
  HttpFile() {
    fs::create_directories(page() / "assets");
    folder_.write("secret", "not for browsers");
    folder_.write("page/index.html", "<p>");
    folder_.write("page/assets/a.js", "1");
  }

  fs::path page() const { return folder_.file("page"); }

  test::TemporaryFolder folder_;
};

TEST_F(HttpFile, IsFoundBelowThePage) {
  EXPECT_EQ(find_file(page(), "/index.html"), fs::canonical(page() / "index.html"));
  EXPECT_EQ(find_file(page(), "/assets/a.js"), fs::canonical(page() / "assets/a.js"));
  EXPECT_EQ(find_file(page().string() + "/", "/index.html"), fs::canonical(page() / "index.html"));
}

TEST_F(HttpFile, IsNeitherAFolderNorMissing) {
  EXPECT_EQ(find_file(page(), "/assets"), std::nullopt);
  EXPECT_EQ(find_file(page(), "/none.html"), std::nullopt);
  EXPECT_EQ(find_file(page() / "none", "/index.html"), std::nullopt);
  EXPECT_EQ(find_file(page(), "index.html"), std::nullopt);
}

TEST_F(HttpFile, IsNotOutsideThePageWhateverThePath) {
  EXPECT_EQ(find_file(page(), "/../secret"), std::nullopt);
  EXPECT_EQ(find_file(page(), "/assets/../../secret"), std::nullopt);
  EXPECT_EQ(find_file(page(), "/" + folder_.file("secret")), std::nullopt);
}

TEST_F(HttpFile, IsNotWhatALinkLeadsToOutside) {
  fs::create_symlink(folder_.file("secret"), page() / "link");
  fs::create_symlink(page() / "index.html", page() / "inner.html");
  EXPECT_EQ(find_file(page(), "/link"), std::nullopt);
  EXPECT_EQ(find_file(page(), "/inner.html"), fs::canonical(page() / "index.html"));
}

// a folder whose name only begins like the page's
TEST_F(HttpFile, IsNotInAFolderBesideThePage) {
  fs::create_directories(folder_.file("page2"));
  folder_.write("page2/a", "x");
  fs::create_symlink(folder_.file("page2/a"), page() / "a");
  EXPECT_EQ(find_file(page(), "/a"), std::nullopt);
}

TEST_F(HttpFile, HasATypeThatABrowserNeedNotGuess) {
  EXPECT_EQ(content_type("/index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(content_type("/assets/a.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(content_type("/a.wasm"), "application/wasm");
  EXPECT_EQ(content_type("/a.html.exe"), "application/octet-stream");
  EXPECT_EQ(content_type("/html"), "application/octet-stream");
}

TEST_F(HttpFile, IsKeptByBrowsersIfItsNameHasTheHashOfItsContent) {
  EXPECT_EQ(cache_control("/index.html"), "no-cache");
  EXPECT_NE(cache_control("/assets/a-1234.js").find("immutable"), std::string_view::npos);
}

}  // namespace
}  // namespace haptic::gateway
