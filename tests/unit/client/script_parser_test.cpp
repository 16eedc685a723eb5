#include "client/cli/script_parser.h"

#include <gtest/gtest.h>

#include <functional>

namespace haptic::cli {
namespace {

using Words = std::vector<std::string>;

std::vector<Words> words_of(const std::string& text, const Variables& defines = {}) {
  std::vector<Words> all;
  for (const ScriptLine& line : read_script(text, defines)) {
    all.push_back(line.words);
  }
  return all;
}

// "LINE: reason" of what is wrong
std::string mistake(const std::string& text) {
  try {
    read_script(text, {});
  } catch (const ScriptError& error) {
    return std::to_string(error.line()) + ": " + error.what();
  }
  return "no mistake";
}

TEST(Script, SplitsLinesIntoWordsAndLeavesCommentsAway) {
  EXPECT_EQ(words_of("# first\n\n  arm   # now\r\nobject\tmove a#b"),
            (std::vector<Words>{{"arm"}, {"object", "move", "a#b"}}));
}

TEST(Script, QuotesLikeAShell) {
  EXPECT_EQ(words_of(R"(echo 'a $b "c"' "d 'e' \" \$f" g\ h "" i'j'k)"),
            (std::vector<Words>{{"echo", "a $b \"c\"", "d 'e' \" $f", "g h", "", "ijk"}}));
}

TEST(Script, SplitsAVariableAtItsSpacesUnlessItIsQuoted) {
  EXPECT_EQ(words_of("set at 0 1 2\necho $at \"$at\" x${at}y"),
            (std::vector<Words>{{"echo", "0", "1", "2", "0 1 2", "x0", "1", "2y"}}));
}

TEST(Script, KeepsTheValueThatWasDefinedOutside) {
  EXPECT_EQ(words_of("set a 1\nset b 2\necho $a $b", {{"a", "7"}}), (std::vector<Words>{{"echo", "7", "2"}}));
}

TEST(Script, UnrollsNestedLoops) {
  EXPECT_EQ(words_of("for a in 1 2\nfor b in x y\necho $a$b\nend\nend"),
            (std::vector<Words>{{"echo", "1x"}, {"echo", "1y"}, {"echo", "2x"}, {"echo", "2y"}}));
}

TEST(Script, CountsLinesAsTheyStandInTheFile) {
  const std::vector<ScriptLine> lines =
      read_script("\nobject move a \\\n  --at 0 0 0\nfor i in 1 2\narm\nend\n", {});
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].line, 2);
  EXPECT_EQ(lines[0].words.size(), 7U);  // object move a --at 0 0 0
  EXPECT_EQ(lines[1].line, 5);
  EXPECT_EQ(lines[2].line, 5);
}

TEST(Script, DoesNotContinueACommentOnTheNextLine) {
  EXPECT_EQ(words_of("# see \\\narm"), (std::vector<Words>{{"arm"}}));
}

TEST(Script, TellsWhatIsWrongAndWhere) {
  EXPECT_EQ(mistake("arm\nend"), "2: end without for");
  EXPECT_EQ(mistake("arm\nfor a in 1\narm"), "2: this for has no end");
  EXPECT_EQ(mistake("for a 1 2\nend"), "1: a loop begins: for name in value...");
  EXPECT_EQ(mistake("for 1a in 1\nend"), "1: for needs the name of a variable: letters, digits, _");
  EXPECT_EQ(mistake("set a"), "1: set needs a value: set name value");
  EXPECT_EQ(mistake("echo $a"), "1: $a has no value");
  EXPECT_EQ(mistake("echo $"), "1: a $ is followed by no name; \\$ is the character itself");
  EXPECT_EQ(mistake("echo ${a"), "1: a $ is followed by no name; \\$ is the character itself");
  EXPECT_EQ(mistake("echo 'a"), "1: a ' is not closed");
  EXPECT_EQ(mistake("\necho \"a"), "2: a \" is not closed");
  EXPECT_EQ(mistake("echo \\"), "1: nothing follows the \\");
  EXPECT_EQ(mistake("echo \x01"), "1: a control character");
  EXPECT_EQ(mistake("for a in 1\nend end\n"), "2: nothing may follow end");
}

TEST(Script, FindsMistakesInLoopsThatRunNever) {
  EXPECT_EQ(mistake("set none ''\nfor a in $none\necho 'x\nend"), "3: a ' is not closed");
}

TEST(Script, BoundsHowMuchItDoes) {
  // 16 loops of 10 turns each would be 10^16 turns
  std::string loops;
  for (int i = 0; i < kMaxNesting; ++i) {
    loops += "for a in 0 1 2 3 4 5 6 7 8 9\n";
  }
  std::string ends;
  for (int i = 0; i < kMaxNesting; ++i) {
    ends += "end\n";
  }
  EXPECT_NE(mistake(loops + ends).find("does more than"), std::string::npos);
  EXPECT_NE(mistake("for a in 1\n" + loops + ends + "end").find("nested deeper"), std::string::npos);
  // doubled 20 times, 100 bytes are 100 MB
  std::string doubling = "set a " + std::string(100, 'x') + "\n";
  for (int i = 0; i < 20; ++i) {
    doubling += "set a $a$a\n";
  }
  EXPECT_NE(mistake(doubling).find("grows too long"), std::string::npos);
  EXPECT_NE(mistake(std::string(kMaxScriptBytes + 1, '\n')).find("longer than"), std::string::npos);
}

}  // namespace
}  // namespace haptic::cli
