#include "s2s/core/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "full_disk.h"
#include "s2s/core/error.h"
#include "temp_folder.h"

using namespace s2s;
using s2s::test::TempFolder;

TEST(AtomicFile, BeforeCommit_FinalNameDoesNotExist) {
  TempFolder folder;
  core::AtomicFile file(folder.file("a.txt"));
  file.stream() << "half";
  file.stream().flush();
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.txt")));
  EXPECT_TRUE(std::filesystem::exists(file.temporaryPath()));
}

TEST(AtomicFile, Commit_LeavesOnlyTheFinishedFile) {
  TempFolder folder;
  core::writeTextFile(folder.file("a.txt"), "whole");
  EXPECT_EQ(test::readBytes(folder.file("a.txt")), "whole");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, DestroyedWithoutCommit_LeavesNothingAndKeepsTheOldFile) {
  TempFolder folder;
  core::writeTextFile(folder.file("a.txt"), "old");
  {
    core::AtomicFile file(folder.file("a.txt"));
    file.stream() << "new";
  }
  EXPECT_EQ(test::readBytes(folder.file("a.txt")), "old");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, MissingParents_AreMade) {
  TempFolder folder;
  core::writeTextFile(folder.file("x/y/a.txt"), "deep");
  EXPECT_EQ(test::readBytes(folder.file("x/y/a.txt")), "deep");
}

TEST(AtomicFile, TemporaryName_KeepsTheExtension) {
  TempFolder folder;
  const core::AtomicFile file(folder.file("a.tif"));
  EXPECT_EQ(std::filesystem::path(file.temporaryPath()).extension(), ".tif");
  EXPECT_EQ(std::filesystem::path(file.temporaryPath()).parent_path(), folder.path());
}

TEST(AtomicFile, ParentIsAFile_ThrowsOutputError) {
  TempFolder folder;
  core::writeTextFile(folder.file("a"), "");
  EXPECT_THROW(core::AtomicFile(folder.file("a/b.txt")), core::OutputError);
}

TEST(AtomicFile, TargetIsAFolder_ThrowsOutputErrorAndLeavesNothing) {
  TempFolder folder;
  std::filesystem::create_directory(folder.file("sub"));
  EXPECT_THROW(core::writeTextFile(folder.file("sub"), "x"), core::OutputError);
  EXPECT_TRUE(std::filesystem::is_directory(folder.file("sub")));
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(AtomicFile, FullDisk_ThrowsOutputErrorAndLeavesNothing) {
  TempFolder folder;
  {
    const test::FullDisk disk(1000);
    EXPECT_THROW(core::writeTextFile(folder.file("a.txt"), std::string(100'000, 'x')), core::OutputError);
  }
  EXPECT_EQ(folder.fileCount(), 0u);
}
