// The completion scripts, as a shell would use them.

#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/toy_daemon.h"

namespace haptic::cli {
namespace {

class Completion : public testing::Test {
 protected:
  Completion() { test::run_program(test::hapticctl() + " completion bash > " + script()); }
  std::string script() const { return folder_.file("completion.bash"); }

  // what bash offers for the last of the words; each ends with a space
  std::string offered(const std::string& words) const {
    return test::run_program("bash -c 'source " + script() + "; COMP_WORDS=(" + test::hapticctl() + " " +
                             words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _hapticctl; "
                             "printf \"%s \" \"${COMPREPLY[@]}\"'")
        .output;
  }

  test::TemporaryFolder folder_;
  test::ToyDaemon daemon_;
};

TEST_F(Completion, IsGoodBash) { EXPECT_EQ(test::run_program("bash -n " + script()).output, ""); }

TEST_F(Completion, OffersVerbs) {
  EXPECT_EQ(offered("ob"), "objects object ");
  EXPECT_EQ(offered("scene s"), "show save ");
  EXPECT_EQ(offered("completion \"\""), "bash zsh fish ");
  EXPECT_EQ(offered("__"), " ");  // hidden
}

TEST_F(Completion, OffersOptionsOfTheVerb) {
  EXPECT_EQ(offered("object move box --"),
            "--help --json --socket --server --certificate --key --authority --at --turn ");
  EXPECT_EQ(offered("scene save --f"), "--force ");
}

TEST_F(Completion, OffersNamesFromTheDaemon) {
  const std::string at = "--socket " + daemon_.address() + " ";
  EXPECT_EQ(offered(at + "object move \"\""), "box ");
  EXPECT_EQ(offered(at + "material set \"\""), "wood ");
  EXPECT_EQ(offered(at + "object set box --inside w"), "wood ");
}

TEST_F(Completion, OffersFilesAfterTheWordThatComesBeforeThem) {
  const std::string file = folder_.write("a.mcap", "");
  EXPECT_EQ(offered("plot fr"), "friction ");
  EXPECT_EQ(offered("plot friction " + folder_.file("a.m")), file + " ");
  EXPECT_EQ(offered("plot friction --fr"), "--from ");
}

TEST_F(Completion, SaysNothingWhenThereIsNoDaemon) {
  EXPECT_EQ(offered("--socket /nowhere object move \"\""), " ");
}

TEST_F(Completion, IsGoodZshAndFish) {
  for (const std::string shell : {"zsh", "fish"}) {
    const std::string other = folder_.file("completion." + shell);
    test::run_program(test::hapticctl() + " completion " + shell + " > " + other);
    const test::Finished read =
        test::run_program(shell + " --no-exec" + (shell == "fish" ? "ute " : " ") + other);
    EXPECT_EQ(read.code, 0) << shell;
    EXPECT_EQ(read.output, "") << shell;
  }
}

TEST_F(Completion, KnowsTheOtherShells) {
  EXPECT_NE(test::run_program(test::hapticctl() + " completion zsh")
                .output.find("'object/move') verb='object move'"),
            std::string::npos);
  EXPECT_NE(test::run_program(test::hapticctl() + " completion fish")
                .output.find("complete -c hapticctl -n '__hapticctl_at \"object move\"' -l at -r"),
            std::string::npos);
  EXPECT_EQ(test::run_program(test::hapticctl() + " completion tcsh").code, 64);
}

}  // namespace
}  // namespace haptic::cli
