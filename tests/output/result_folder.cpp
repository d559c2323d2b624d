// Results appear completely or not at all, and only one run writes them.
#include <apsis/output/result_folder.hpp>

#include "support/folder.hpp"

#include <apsis/core/errors.hpp>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace result_folder_test {

using namespace apsis;
using testing::UnorderedElementsAre;
namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> visible(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const auto name = entry.path().filename().string(); name.front() != '.') names.push_back(name);
  return names;
}

}  // namespace

TEST(results, replace_earlier_ones_together) {
  const test_folder place;
  const fs::path path = place / "a/b";
  {
    result_folder folder(path);
    folder.prepare_text("fields.csv", "old\n");
    folder.prepare_text(result_folder::manifest, "{}\n");
    EXPECT_TRUE(visible(path).empty()) << "nothing appears before the commit";
    folder.commit();
  }
  EXPECT_THAT(visible(path), UnorderedElementsAre("fields.csv", "manifest.json"));
  {
    result_folder folder(path);
    folder.prepare_text("fields.csv", "new\n");
    EXPECT_EQ(text_of(path / "fields.csv"), "old\n");
  }
  EXPECT_EQ(text_of(path / "fields.csv"), "old\n") << "not committed";
  EXPECT_THAT(visible(path), UnorderedElementsAre("fields.csv", "manifest.json"));
}

TEST(results, remove_drawn_pictures_of_earlier_ones_and_no_other_file) {
  const test_folder place;
  const fs::path path = place / "o", pictures = path / "pictures";
  fs::create_directories(pictures);
  const auto write = [](const fs::path& file, const std::string& text) { std::ofstream(file) << text; };
  const auto commit = [&path] {
    testing::internal::CaptureStderr();
    result_folder folder(path);
    folder.prepare_text(result_folder::manifest, "{}\n");
    folder.commit();
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(commit(), "");
  EXPECT_FALSE(fs::exists(pictures)) << "an empty folder";
  // CBF43926 is the CRC-32 of these digits in its definition.
  fs::create_directories(pictures);
  for (const char* name : {"fields.png", "wall disc.png", "changed.png", "mine.png"})
    write(pictures / name, "123456789");
  write(pictures / "changed.png", "123456780");
  write(path / "beside.png", "123456789");
  fs::create_symlink(path / "beside.png", pictures / "link.png");
  write(pictures / ".written",
        "cbf43926 9 fields.png\ncbf43926 9 wall disc.png\ncbf43926 9 changed.png\ncbf43926 9 link.png\n"
        "cbf43926 9 ../beside.png\ncbf43926 9 gone.png\n");
  const std::string log = commit();
  EXPECT_THAT(visible(pictures), UnorderedElementsAre("changed.png", "mine.png", "link.png"));
  EXPECT_TRUE(fs::exists(path / "beside.png"));
  EXPECT_THAT(
      log, testing::HasSubstr("removed 2 pictures of the earlier run from '" + pictures.string() +
                              "' (they show its results); apsis plot " + path.string() + " draws new ones"));
  EXPECT_THAT(log, testing::HasSubstr("has 3 files that apsis did not draw, or that changed since"));
  // A folder that is a link stays as it is.
  fs::rename(pictures, place / "elsewhere");
  fs::create_directory_symlink(place / "elsewhere", pictures);
  write(fs::path(place / "elsewhere") / ".written", "cbf43926 9 mine.png\n");
  EXPECT_EQ(commit(), "");
  EXPECT_TRUE(fs::exists(pictures / "mine.png"));
}

TEST(results, of_a_writer_that_fails_leave_nothing) {
  const test_folder place;
  const fs::path path = place / "o";
  {
    result_folder folder(path);
    const auto failing = [](const std::string& file) {
      std::ofstream(file) << "half";
      throw std::runtime_error("the disk is full");
    };
    EXPECT_THROW(folder.prepare("fields.csv", failing), std::runtime_error);
    EXPECT_THROW(folder.publish("checkpoint.h5", failing), std::runtime_error);
  }
  EXPECT_FALSE(fs::exists(path) && !fs::is_empty(path));
}

TEST(results, published_during_a_run_appear_immediately) {
  const test_folder place;
  const fs::path path = place / "o";
  result_folder folder(path);
  folder.publish_text("checkpoint.txt", "1\n");
  folder.publish_text("checkpoint.txt", "2\n");
  EXPECT_EQ(text_of(path / "checkpoint.txt"), "2\n");
  EXPECT_THROW(result_folder{path}, io_error) << "the folder is locked";
}

}  // namespace result_folder_test
