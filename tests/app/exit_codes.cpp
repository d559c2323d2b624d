// Unsuitable files: one message and one exit code for every command that reads a file.
#include "program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace exit_codes_test {

using namespace app_test;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

namespace fs = std::filesystem;

constexpr int input = 2, output = 4;

/// A command line, in which "FILE" stands for the file in question. The exit codes are those for a missing
/// file, a folder, and bytes that are not text.
struct reader {
  std::vector<std::string> arguments;
  int missing, folder, garbage;
};

const std::vector<reader> readers = {
    {{"run", "FILE"}, input, input, input},
    {{"converge", "FILE", "--vary", "time.dt=0.1,0.05"}, input, input, input},
    {{"check", "FILE"}, input, output, input},
    {{"show", "FILE"}, input, input, input},
    {{"plot", "FILE"}, input, input, input},
    {{"plot", "--compare", "both", "FILE"}, input, input, input},
    {{"report", "FILE"}, output, output, output},
#if APSIS_HAS_DESIGN
    {{"design", "--order", "2", "--stages", "3", "--out", "d.toml", "--from", "FILE"}, input, output, input},
    {{"design", "--out", "d.toml", "--embedded", "FILE"}, input, output, input},
#endif
    {{"run", "paper/ode", "--restart", "FILE"}, input, input, input},
    {{"run", "paper/ode", "time.method=FILE"}, input, output, input},
};

void expect_failure(const work_folder& folder, const reader& r, const std::string& file, int code) {
  auto arguments = r.arguments;
  for (auto& argument : arguments)
    if (const auto at = argument.find("FILE"); at != std::string::npos) argument.replace(at, 4, file);
  SCOPED_TRACE(arguments.front() + " " + arguments.back());
  const auto before = folder.listing();
  const outcome result = run_apsis(folder, arguments);
  // Without Python no picture is drawn. The program reports this before it reads the file.
  if (result.err.find("pictures cannot be drawn") != std::string::npos) return;
  EXPECT_EQ(result.code, code) << result.err;
  EXPECT_THAT(result.err, HasSubstr("error: "));
  EXPECT_EQ(result.err.find("error: "), result.err.rfind("error: ")) << result.err;
  EXPECT_THAT(result.err, HasSubstr(file));
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_EQ(folder.listing(), before);
}

const std::string bom = "\xef\xbb\xbf";

std::string with_windows_line_ends(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? "\r\n" : std::string(1, c);
  return out;
}

std::string with_tabs(const std::string& text) {
  std::string out = "\t";
  for (std::size_t k = 0; k < text.size(); ++k) {
    out += text[k];
    if (text[k] == '\n' && k + 1 < text.size()) out += '\t';
  }
  return out;
}

}  // namespace

TEST(exit_codes, of_files_that_are_missing_folders_or_no_text) {
  const work_folder folder;
  fs::create_directory(folder.path() / "folder.toml");
  std::string bytes;
  for (int k = 0; k < 4096; ++k) bytes += static_cast<char>((k * 197 + 128) % 256);
  folder.file("binary.toml", bytes);
  for (const auto& r : readers) {
    expect_failure(folder, r, "missing.toml", r.missing);
    expect_failure(folder, r, "folder.toml", r.folder);
    expect_failure(folder, r, "binary.toml", r.garbage);
  }
}

TEST(exit_codes, of_files_that_cannot_be_read) {
  const work_folder folder;
  // This is the first page of a process's memory. Every user can open it, but reading fails, even for root.
  fs::create_symlink("/proc/self/mem", folder.path() / "broken.toml");
  folder.file("closed.toml", "[model]\n");
  fs::permissions(folder.path() / "closed.toml", fs::perms::none);
  std::vector<std::string> unreadable = {"broken.toml"};
  if (geteuid() != 0) unreadable.emplace_back("closed.toml");
  for (const auto& file : unreadable)
    for (const char* command : {"run", "check"}) {
      const outcome result = run_apsis(folder, {command, file});
      EXPECT_EQ(result.code, output) << command << " " << file << ": " << result.err;
      EXPECT_THAT(result.err, HasSubstr("cannot read '" + file)) << command;
    }
}

TEST(exit_codes, files_may_have_a_byte_order_mark_windows_line_ends_and_tabs) {
  const work_folder folder;
  const std::string text = run_apsis(folder, {"show", "paper/decay"}).out;
  const std::string method = run_apsis(folder, {"show", "imdrk-1-2", "--format", "toml"}).out;
  const auto run = [&folder](const std::string& name) {
    const outcome result = run_apsis(folder, {"run", name});
    EXPECT_EQ(result.code, 0) << name << result.err;
    return result.out.substr(0, result.out.find("wall time"));
  };
  const std::string plain = run(folder.file("plain.toml", text));
  EXPECT_EQ(run(folder.file("bom.toml", bom + text)), plain);
  EXPECT_EQ(run(folder.file("crlf.toml", with_windows_line_ends(text))), plain);
  EXPECT_EQ(run(folder.file("tabs.toml", with_tabs(text))), plain);
  for (const std::string& form : {bom + method, with_windows_line_ends(method), with_tabs(method)})
    EXPECT_EQ(run_apsis(folder, {"check", folder.file("m.toml", form)}).code, 0);
  // Positions count a tab and a line end as one character each.
  const outcome wrong = run_apsis(
      folder, {"run", folder.file("w.toml", with_windows_line_ends("title = \"t\"\n\tcels = 3\n"))});
  EXPECT_EQ(wrong.code, input);
  EXPECT_THAT(wrong.err, HasSubstr("w.toml:"));
}

}  // namespace exit_codes_test
