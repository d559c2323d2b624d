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
