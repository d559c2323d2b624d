// A seal notices every change of a file.
#include <apsis/output/sealed_file.hpp>

#include "support/folder.hpp"

#include <apsis/core/errors.hpp>

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace sealed_file_test {

using namespace apsis;

namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

void check(const std::string& path, const std::string& kind = "checkpoint") {
  check_seal(path, kind);
}

}  // namespace

TEST(a_seal, accepts_the_file_and_no_other) {
  const test_folder folder;
  const std::string path = folder / "file";
  write(path, std::string(seal_length, ' ') + "the content of a file\n");
  seal(path, "checkpoint");
  EXPECT_NO_THROW(check(path));
  bad_input::expect_refused({
      {[&] { check(path, "solution"); }, {path}, 4},
  });
  const std::string sealed = bytes_of(path);
  for (std::size_t at = seal_length; at < sealed.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = sealed;
      changed[at] = static_cast<char>(changed[at] ^ (1 << bit));
      write(path, changed);
      bad_input::expect_refused({
          {[&] { check(path); }, {path}, 4},
      });
    }
  for (std::size_t kept = 0; kept < sealed.size(); kept += 7) {
    write(path, sealed.substr(0, kept));
    bad_input::expect_refused({
        {[&] { check(path); }, {path}, 4},
    });
  }
  write(path, sealed + "more");
  bad_input::expect_refused({
      {[&] { check(path); }, {path}, 4},
  });
  write(path, sealed);
  EXPECT_NO_THROW(check(path));
}

TEST(a_seal, names_the_version_of_another_program) {
  const test_folder folder;
  const std::string path = folder / "file";
  write(path, std::string(seal_length, ' '));
  seal(path, "checkpoint", "0.0.7");
  bad_input::expect_refused({
      {[&] { check(path); }, {"0.0.7"}, 4},
  });
  std::filesystem::remove(path);
  bad_input::expect_refused({
      {[&] { check(path); }, {path}, 4},
  });
}

}  // namespace sealed_file_test
