// Text files: reading up to a size limit, and complete writing.
#include <apsis/core/text_file.hpp>

#include <apsis/core/errors.hpp>

#include <csignal>
#include <filesystem>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/folder.hpp>
#include <sys/resource.h>

namespace text_file_test {

using namespace apsis;
using testing::HasSubstr;

namespace {

template <class F>
std::string complaint(F call) {
  try {
    call();
  } catch (const io_error& problem) {
    return problem.what();
  }
  return "";
}

}  // namespace

TEST(text_file, is_read_back_byte_for_byte) {
  const test_folder folder;
  const std::string text("a\r\nb\0c\n\xff", 8);
  write_text_file(folder / "f", text);
  EXPECT_EQ(read_text_file(folder / "f", 100, "file"), text);
  // A shorter text replaces the previous file completely.
  write_text_file(folder / "f", "");
  EXPECT_EQ(read_text_file(folder / "f", 100, "file"), "");
}

TEST(text_file, is_read_up_to_one_byte_beyond_the_limit) {
  const test_folder folder;
  write_text_file(folder / "f", "12345");
  EXPECT_EQ(read_text_file(folder / "f", 5, "file"), "12345");
  EXPECT_EQ(read_text_file(folder / "f", 4, "file"), "12345");
  EXPECT_EQ(read_text_file(folder / "f", 2, "file"), "123");
}

TEST(text_file, of_infinite_length_is_read_up_to_the_limit) {
  EXPECT_EQ(read_text_file("/dev/zero", 1000, "file").size(), 1001U);
}

TEST(text_file, that_cannot_be_read_is_named_in_the_error) {
  const test_folder folder;
  for (const std::string& path : {folder / "none", folder / ""}) {
    const std::string text = complaint([&] { read_text_file(path, 10, "case file"); });
    EXPECT_EQ(text, "cannot read '" + path + "' (it is a folder or not readable); give a readable case file");
  }
}

TEST(text_file, that_cannot_be_written_is_named_with_its_reason_and_a_suggestion) {
  const test_folder folder;
  std::filesystem::create_directory(folder / "folder");
  write_text_file(folder / "file", "");
  const std::string gone = "there is no folder '" + (folder / "none") + "', it may have been deleted";
  const std::pair<std::string, std::string> refused[] = {
      {folder / "none/f", gone},
      {folder / "folder", "something that is not a file has this name"},
      {"/dev/full", "something that is not a file has this name"},
      {folder / "file/f", "Not a directory"},
      {folder / std::string(300, 'n'), "File name too long"},
      {"/proc/self/f", "No such file or directory"}};
  for (const auto& [path, reason] : refused) {
    const std::string text = complaint([&, &path = path] { write_text_file(path, "text", "set TMPDIR"); });
    EXPECT_EQ(text, "cannot write '" + path + "' (" + reason + "); set TMPDIR");
  }
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

TEST(text_file, of_a_full_disk_is_an_error) {
  const test_folder folder;
  // A limit of the file size acts as a full disk.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string text =
      complaint([&] { write_text_file(folder / "f", std::string(5000, 'a'), "free some"); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(text, "cannot write '" + (folder / "f") + "' (File too large); free some");
}

TEST(text_file, is_never_written_through_a_link) {
  const test_folder folder;
  write_text_file(folder / "mine", "precious");
  std::filesystem::create_symlink(folder / "mine", folder / "symbolic");
  std::filesystem::create_hard_link(folder / "mine", folder / "hard");
  std::filesystem::create_symlink(folder / "new", folder / "dangling");
  for (const char* planted : {"symbolic", "hard", "dangling"}) {
    write_text_file(folder / planted, "result");
    EXPECT_EQ(read_text_file(folder / planted, 100, "file"), "result") << planted;
    EXPECT_FALSE(std::filesystem::is_symlink(folder / planted)) << planted;
  }
  EXPECT_EQ(read_text_file(folder / "mine", 100, "file"), "precious");
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

}  // namespace text_file_test
