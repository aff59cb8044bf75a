#include "s2s/eval/text_table.h"

#include <gtest/gtest.h>

#include <limits>

using namespace s2s::eval;

TEST(TextTable, Columns_AreAsWideAsTheirWidestCell) {
  TextTable table({"name", "x [m]"});
  table.addRow({"a", "1.25"});
  table.addRow({"longer", "-100.50"});
  table.addRow({"Ø"});
  EXPECT_EQ(table.print(),
            "name      x [m]\n"
            "---------------\n"
            "a          1.25\n"
            "longer  -100.50\n"
            "Ø\n");
}

TEST(Fixed, NumbersAndNothing_ArePrinted) {
  EXPECT_EQ(fixed(-1.25, 1), "-1.2");
  EXPECT_EQ(fixed(2, 3), "2.000");
  EXPECT_EQ(fixed(std::numeric_limits<double>::quiet_NaN(), 3), "-");
}
