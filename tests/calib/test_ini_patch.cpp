#include <gtest/gtest.h>

#include "s2s/calib/ini_patch.h"

namespace s2s::calib {
namespace {

TEST(IniPatch, KnownKey_ChangesNothingButItsValue) {
  const std::string text =
      "// head\n[other]\npose = 9\n\n[mapper]  # vessel\nlabel = A\npose = 1 2 3 // tape\n\n[last]\nx = 1\n";
  EXPECT_EQ(patchedIni(text, "mapper", "pose", "4 5 6"),
            "// head\n[other]\npose = 9\n\n[mapper]  # vessel\nlabel = A\npose = 4 5 6 // tape\n\n[last]\nx = 1\n");
}

TEST(IniPatch, MissingKey_EndsItsSection) {
  EXPECT_EQ(patchedIni("[mapper]\nlabel = A\n\n// of the last\n[last]\nx = 1\n", "mapper", "pose", "1"),
            "[mapper]\nlabel = A\npose = 1\n\n// of the last\n[last]\nx = 1\n");
}

TEST(IniPatch, MissingSection_EndsTheFile) {
  EXPECT_EQ(patchedIni("[last]\nx = 1", "mapper", "pose", "1"), "[last]\nx = 1\n\n[mapper]\npose = 1\n");
}

TEST(IniPatch, CommentedKey_IsNoKey) {
  EXPECT_EQ(patchedIni("[mapper]\n// pose = 0\n", "mapper", "pose", "1"), "[mapper]\npose = 1\n// pose = 0\n");
}

}  // namespace
}  // namespace s2s::calib
