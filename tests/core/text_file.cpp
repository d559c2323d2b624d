// Text files: reading up to a size limit, and complete writing.
#include <apsis/core/text_file.hpp>

#include <apsis/core/errors.hpp>

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/folder.hpp>

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

TEST(text_file, that_cannot_be_written_completely_is_named_with_a_suggestion) {
  const test_folder folder;
  // /dev/full can be opened but rejects all writes, like a full disk.
  for (const std::string& path : {folder / "none/f", folder / "", std::string("/dev/full")}) {
    const std::string text = complaint([&] { write_text_file(path, "text", "set TMPDIR"); });
    EXPECT_EQ(text, "cannot write '" + path + "' (no permission or no space left); set TMPDIR");
  }
}

}  // namespace text_file_test
