#include "client/cli/table.h"

#include <gtest/gtest.h>

namespace haptic::cli {
namespace {

TEST(Table, LinesUpItsColumns) {
  Table table({{"name", Align::kLeft}, {"x mm"}, {"state", Align::kLeft}});
  table.add({"a", "+1.00", "present"});
  table.add({"longer", "-12.50", "-"});
  EXPECT_EQ(table.to_string(),
            "name      x mm  state\n"
            "a        +1.00  present\n"
            "longer  -12.50  -\n");
}

TEST(Table, CountsCharactersAndNotBytes) {
  Table table({{"n", Align::kLeft}, {"v"}});
  table.add({"\u00e4\u00f6", "1"});
  EXPECT_EQ(table.to_string(), "n   v\n\u00e4\u00f6  1\n");
}

TEST(Table, LeavesMissingCellsEmpty) {
  Table table({{"a", Align::kLeft}, {"b", Align::kLeft}});
  table.add({"x"});
  EXPECT_EQ(table.to_string(), "a  b\nx\n");
}

}  // namespace
}  // namespace haptic::cli
