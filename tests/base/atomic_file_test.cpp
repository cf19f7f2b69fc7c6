#include "base/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace rhexis {
namespace {
namespace fs = std::filesystem;

std::string contents_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A folder of its own for every test, gone afterwards.
class AtomicFile : public testing::Test {
 protected:
  AtomicFile() {
    std::string name = testing::TempDir() + "rhexis-atomic-XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  ~AtomicFile() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename());
    return found;
  }

  fs::path folder_;
};

TEST_F(AtomicFile, WritesBytesAsTheyAre) {
  const std::string bytes("a\0b\r\n\xff", 6);
  ASSERT_TRUE(write_atomically(folder_ / "x.bin", bytes).has_value());
  EXPECT_EQ(contents_of(folder_ / "x.bin"), bytes);
  EXPECT_EQ(names(), std::vector<std::string>{"x.bin"});
}

TEST_F(AtomicFile, MakesMissingFolders) {
  const fs::path path = folder_ / "a" / "b" / "x.txt";
  ASSERT_TRUE(write_atomically(path, "x").has_value());
  EXPECT_EQ(contents_of(path), "x");
}

TEST_F(AtomicFile, ReplacesTheOldFileOnlyWhenTheNewOneIsComplete) {
  const fs::path path = folder_ / "x.txt";
  ASSERT_TRUE(write_atomically(path, "old").has_value());
  const auto write = [&](const fs::path& temporary) -> Expected<void> {
    EXPECT_EQ(temporary.parent_path(), folder_);
    std::ofstream(temporary) << "new";
    EXPECT_EQ(contents_of(path), "old");
    return {};
  };
  ASSERT_TRUE(write_atomically(path, write).has_value());
  EXPECT_EQ(contents_of(path), "new");
}

TEST_F(AtomicFile, FailureOfTheWriterLeavesTheOldFileAndNothingElse) {
  const fs::path path = folder_ / "x.txt";
  ASSERT_TRUE(write_atomically(path, "old").has_value());
  const auto half = [](const fs::path& temporary) -> Expected<void> {
    std::ofstream(temporary) << "half";
    return fail("the disk is full");
  };
  const Expected<void> written = write_atomically(path, half);
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().what, "the disk is full");
  EXPECT_EQ(contents_of(path), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"x.txt"});
}

TEST_F(AtomicFile, FolderInTheWayIsAnErrorThatNamesTheFile) {
  const fs::path path = folder_ / "x";
  fs::create_directories(path / "occupied");
  const Expected<void> written = write_atomically(path, "x");
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().file, path.string());
  EXPECT_EQ(names(), std::vector<std::string>{"x"});
}

TEST_F(AtomicFile, FileWhereAFolderShouldBeIsAnError) {
  ASSERT_TRUE(write_atomically(folder_ / "x", "x").has_value());
  const Expected<void> written = write_atomically(folder_ / "x" / "y", "y");
  ASSERT_FALSE(written.has_value());
  EXPECT_NE(written.error().message().find((folder_ / "x").string()), std::string::npos);
}

TEST_F(AtomicFile, TemporariesTellWhatTheyWouldBecome) {
  std::string temporary;
  const auto write = [&](const fs::path& path) -> Expected<void> {
    temporary = path.filename();
    std::ofstream(path) << "x";
    return {};
  };
  ASSERT_TRUE(write_atomically(folder_ / "x.part7.txt", write).has_value());
  EXPECT_NE(temporary, "x.part7.txt");
  EXPECT_EQ(finished_name(temporary), "x.part7.txt");
  for (const std::string_view name : {"x.txt", "x.part", "x.part7.txt", "x.part7a", ""})
    EXPECT_EQ(finished_name(name), name);
}

TEST(AtomicFileOnAFullDisk, IsAnError) {
  // /dev/full takes no byte. The rename is never reached: the temporary, a link to it, is removed.
  const fs::path link = fs::path(testing::TempDir()) / ("rhexis-full.part" + std::to_string(::getpid()));
  fs::create_symlink("/dev/full", link);
  const fs::path path = fs::path(testing::TempDir()) / "rhexis-full";
  const Expected<void> written = write_atomically(path, "x");
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().message(),
            path.string() + ": cannot write: No space left on device (choose a folder that can be written to)");
  EXPECT_FALSE(fs::exists(path));
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
}

}  // namespace
}  // namespace rhexis
