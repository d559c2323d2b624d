#pragma once

#include <apsis/output/folder_lock.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// The result folder of a run, locked against other runs (folder_lock). Files are prepared under temporary
/// names and renamed together in commit(). Until then the results of an earlier run are untouched. Prepared
/// files are removed if commit() is not reached. Every member throws io_error.
class result_folder {
 public:
  /// Creates the folder and its parents, and verifies that a file can be written into it.
  explicit result_folder(std::filesystem::path path);
  ~result_folder();
  result_folder(const result_folder&) = delete;
  result_folder& operator=(const result_folder&) = delete;

  /// Returns the path as given.
  const std::filesystem::path& path() const { return path_; }

  /// Prepares a file; `write` is called with its temporary path.
  void prepare(const std::string& name, const std::function<void(const std::string&)>& write);
  /// Prepares a file with the given content.
  void prepare_text(const std::string& name, const std::string& text);

  /// Writes one file and renames it immediately (checkpoints during a run).
  void publish(const std::string& name, const std::function<void(const std::string&)>& write);

  /// Writes one file with the given content and renames it immediately.
  void publish_text(const std::string& name, const std::string& text);

  /// Adds a file to a series, which is a subfolder. Its files are complete as soon as they appear. A killed
  /// run leaves them for its restart. The series gets its name in commit().
  void add_to_series(const std::string& series, const std::string& name,
                     const std::function<void(const std::string&)>& write);
  /// Begins a series with the files in `from`, the folder of an earlier run, for which `keep` is true.
  void resume_series(const std::string& series, const std::filesystem::path& from,
                     const std::function<bool(const std::string& path)>& keep);
  /// Returns the sorted paths of the files of a series so far.
  std::vector<std::filesystem::path> files_of_series(const std::string& series) const;

  /// Renames every prepared file and series, the manifest last, and removes result files of an earlier run
  /// that this run did not write. Also removes its pictures (remove_drawn_pictures()), and logs this.
  void commit();

  /// Describes the other files; absent while they are being replaced.
  static constexpr const char* manifest = "manifest.json";

 private:
  std::filesystem::path temporary(const std::string& name) const;
  void begin_series(const std::string& series);
  void commit_series();
  void discard() noexcept;

  std::filesystem::path path_;
  std::optional<folder_lock> lock_;
  std::vector<std::filesystem::path> made_;  ///< folders created here, outermost first
  std::vector<std::string> prepared_, series_;
  bool keep_ = false;
};

}  // namespace apsis
