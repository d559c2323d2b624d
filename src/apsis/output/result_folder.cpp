#include <apsis/output/result_folder.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/new_file.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/output/drawn_pictures.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <ranges>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace apsis {
namespace fs = std::filesystem;
namespace {

constexpr std::array<const char*, 14> result_names = {result_folder::manifest,
                                                      "history.csv",
                                                      "fields.csv",
                                                      "solution.h5",
                                                      "solution.xdmf",
                                                      "checkpoint.h5",
                                                      "converge.csv",
                                                      "converge.json",
                                                      "picture.json",
                                                      "converge.png",
                                                      "sweep.csv",
                                                      "sweep.json",
                                                      "sweep.png",
                                                      "report.html"};

constexpr std::array<const char*, 4> series_names = {"snapshots", "probes", "slices", "surfaces"};

constexpr const char* advice = "choose another folder with --out or free some space";

/// Returns the advice for an error; only a full disk needs space.
const char* advice_for(const std::error_code& why) {
  return why == std::errc::no_space_on_device ? advice : "choose another folder with --out";
}

[[noreturn]] void cannot(const std::string& verb, const fs::path& path, const std::string& why,
                         const char* suggestion) {
  throw io_error(fmt::format("cannot {} '{}' ({}); {}", verb, path.string(), why, suggestion));
}
[[noreturn]] void cannot(const std::string& verb, const fs::path& path, const std::error_code& why) {
  cannot(verb, path, why_not_written(path.string(), why.value()), advice_for(why));
}

/// Returns whether the path is a folder and not a link to one, because files are not written through links.
bool is_own_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored).type() == fs::file_type::directory;
}

std::string number_of_pictures(int count) {
  return count == 1 ? "1 picture" : fmt::format("{} pictures", count);
}

/// Removes the pictures of an earlier run, and logs what became of them.
void replace_pictures(const fs::path& folder) {
  const picture_counts counts = remove_drawn_pictures(folder);
  const std::string pictures = (folder / "pictures").string();
  if (counts.removed > 0)
    log::info(
        fmt::format("removed {} of the earlier run from '{}' (they show its results); apsis plot {} draws "
                    "new ones",
                    number_of_pictures(counts.removed), pictures, folder.string()));
  if (counts.left > 0)
    log::info(
        fmt::format("'{}' has {} that apsis did not draw, or that changed since (they stay, and may show "
                    "other results); remove what you do not need",
                    pictures, counts.left == 1 ? "1 file" : fmt::format("{} files", counts.left)));
}

/// Flushes the directory so that renames are durable.
void sync_folder(const fs::path& folder) {
  const int id = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (id < 0) return;  // not supported by every file system
  fsync(id);
  close(id);
}

}  // namespace

result_folder::result_folder(fs::path path) : path_(std::move(path)) {
  std::error_code problem;
  // A trailing slash would make the last folder look empty.
  fs::path folder = path_.has_filename() ? path_ : path_.parent_path();
  for (; !folder.empty() && !fs::exists(folder, problem); folder = folder.parent_path()) {
    if (problem) break;
    made_.insert(made_.begin(), folder);
  }
  problem.clear();
  fs::create_directories(path_, problem);
  if (problem || !fs::is_directory(path_)) {
    discard();
    cannot("create the folder", path_, problem ? problem.message() : "a file has this name",
           advice_for(problem));
  }
  const fs::path probe = temporary("probe");
  try {
    lock_.emplace(path_);
    write_text_file(probe.string(), "apsis\n", advice);
  } catch (const io_error&) {
    discard();
    throw;
  }
  fs::remove(probe, problem);
}

result_folder::~result_folder() {
  discard();
}

void result_folder::discard() noexcept {
  std::error_code ignored;
  for (const auto& name : prepared_) fs::remove(temporary(name), ignored);
  prepared_.clear();
  if (keep_) {
    lock_.reset();
    return;
  }
  for (const auto& series : series_) fs::remove_all(temporary(series), ignored);
  lock_.reset();
  // Removes a folder only while it is empty.
  for (const auto& folder : std::views::reverse(made_)) fs::remove(folder, ignored);
}

fs::path result_folder::temporary(const std::string& name) const {
  return path_ / fmt::format(".{}.partial", name);
}

void result_folder::prepare(const std::string& name, const std::function<void(const std::string&)>& write) {
  if (std::find(prepared_.begin(), prepared_.end(), name) == prepared_.end()) prepared_.push_back(name);
  write(temporary(name).string());
}

void result_folder::prepare_text(const std::string& name, const std::string& text) {
  prepare(name, [&text](const std::string& path) { write_text_file(path, text, advice); });
}

void result_folder::publish(const std::string& name, const std::function<void(const std::string&)>& write) {
  prepare(name, write);
  std::error_code problem;
  fs::rename(temporary(name), path_ / name, problem);
  if (problem) cannot("write", path_ / name, problem);
  sync_folder(path_);
  prepared_.erase(std::find(prepared_.begin(), prepared_.end(), name));
  keep_ = true;
}

void result_folder::publish_text(const std::string& name, const std::string& text) {
  publish(name, [&text](const std::string& path) { write_text_file(path, text, advice); });
}

void result_folder::begin_series(const std::string& series) {
  if (std::find(series_.begin(), series_.end(), series) != series_.end()) return;
  std::error_code problem;
  fs::remove_all(temporary(series), problem);
  // Creates no parents: a result folder that was deleted is an error.
  fs::create_directory(temporary(series), problem);
  if (problem || !is_own_folder(temporary(series))) cannot("create the folder", temporary(series), problem);
  series_.push_back(series);
}

void result_folder::add_to_series(const std::string& series, const std::string& name,
                                  const std::function<void(const std::string&)>& write) {
  begin_series(series);
  const fs::path target = temporary(series) / name, beside = temporary(series) / ("." + name + ".partial");
  write(beside.string());
  std::error_code problem;
  fs::rename(beside, target, problem);
  if (problem) cannot("write", target, problem);
}

std::vector<fs::path> result_folder::files_of_series(const std::string& series) const {
  std::vector<fs::path> files;
  std::error_code problem;
  for (const auto& entry : fs::directory_iterator(temporary(series), problem))
    if (entry.path().filename().string().front() != '.') files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void result_folder::resume_series(const std::string& series, const fs::path& from,
                                  const std::function<bool(const std::string& path)>& keep) {
  // A killed run left its files under the temporary name.
  const fs::path left = from / temporary(series).filename();
  std::error_code problem;
  const fs::path source = is_own_folder(left) ? left : from / series;
  const bool here = fs::equivalent(source, temporary(series), problem);
  if (here) {
    keep_ = true;  // files of an earlier run, kept if this one fails
    series_.push_back(series);
    for (const auto& path : files_of_series(series))
      if (!keep(path.string())) fs::remove(path, problem);
    return;
  }
  begin_series(series);
  for (const auto& entry : fs::directory_iterator(source, problem)) {
    const auto name = entry.path().filename();
    if (name.string().front() == '.' || !keep(entry.path().string())) continue;
    fs::create_hard_link(entry.path(), temporary(series) / name, problem);
    if (problem) fs::copy_file(entry.path(), temporary(series) / name, problem);
    if (problem) cannot("copy", entry.path(), problem);
  }
}

void result_folder::commit_series() {
  std::error_code problem;
  for (const std::string name : series_names) {
    fs::remove_all(path_ / name, problem);
    problem.clear();
    if (std::find(series_.begin(), series_.end(), name) == series_.end()) {
      fs::remove_all(temporary(name), problem);  // left by a killed run that is not continued
      continue;
    }
    fs::rename(temporary(name), path_ / name, problem);
    if (problem) cannot("write", path_ / name, problem);
    keep_ = true;
  }
  series_.clear();
}

void result_folder::commit() {
  std::error_code problem;
  // Removes files of a run that was killed while writing.
  for (const char* name : result_names)
    if (std::find(prepared_.begin(), prepared_.end(), name) == prepared_.end())
      fs::remove(temporary(name), problem);
  // There is no manifest during renames, so that an existing one describes the files beside it.
  fs::remove(path_ / manifest, problem);
  std::partition(prepared_.begin(), prepared_.end(),
                 [](const std::string& name) { return name != manifest; });
  for (const char* name : result_names)
    if (std::find(prepared_.begin(), prepared_.end(), name) == prepared_.end())
      fs::remove(path_ / name, problem);
  commit_series();
  replace_pictures(path_);
  for (const auto& name : prepared_) {
    problem.clear();
    fs::rename(temporary(name), path_ / name, problem);
    if (problem) cannot("write", path_ / name, problem);
    keep_ = true;
  }
  sync_folder(path_);
  prepared_.clear();
}

}  // namespace apsis
