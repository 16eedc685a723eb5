#include "client/cli/screen.h"

#include <gtest/gtest.h>

namespace haptic::cli {
namespace {

TEST(Fit, CutsRowsAndColumnsToTheWindow) {
  EXPECT_EQ(fit("abcdef\nghi\njkl\n", 2, 4), "abcd\033[K\r\nghi\033[K");
}

TEST(Fit, NeverCutsWithinACharacter) { EXPECT_EQ(fit("\u00e4\u00f6\u00fc", 1, 2), "\u00e4\u00f6\033[K"); }

TEST(Fit, OfNothingIsNothing) { EXPECT_EQ(fit("", 10, 10), ""); }

}  // namespace
}  // namespace haptic::cli
