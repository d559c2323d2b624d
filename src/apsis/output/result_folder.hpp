#pragma once

#include <apsis/output/folder_lock.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// The folder of a run's results, locked against other runs (folder_lock). Files are prepared under temporary
/// names inside it and take their names together in commit(); until then results of an earlier run stay as
/// they are, and whatever was made is removed again if commit() is never reached. Everything throws io_error.
class result_folder {
 public:
  /// Makes the folder (and those above it) and proves that a file can be written into it.
  explicit result_folder(std::filesystem::path path);
  ~result_folder();
  result_folder(const result_folder&) = delete;
  result_folder& operator=(const result_folder&) = delete;

  /// As it was given.
  const std::filesystem::path& path() const { return path_; }

  /// Prepares a file of this name; `write` is called with the temporary path.
  void prepare(const std::string& name, const std::function<void(const std::string&)>& write);
  /// Prepares a file with this content.
  void prepare_text(const std::string& name, const std::string& text);

  /// Prepares and names one file at once (checkpoints of a run that goes on).
  void publish(const std::string& name, const std::function<void(const std::string&)>& write);

  /// Prepares and names one file with this content.
  void publish_text(const std::string& name, const std::string& text);

  /// Adds a file to a series, which is a folder below this one. Such files are whole as soon as they are
  /// there, and a run that was killed leaves them for its continuation; the series takes its name in
  /// commit().
  void add_to_series(const std::string& series, const std::string& name,
                     const std::function<void(const std::string&)>& write);
  /// Begins a series with those files of `from`, the folder of an earlier run, that `keep` wants.
  void resume_series(const std::string& series, const std::filesystem::path& from,
                     const std::function<bool(const std::string& path)>& keep);
  /// Paths of the files of a series so far, sorted.
  std::vector<std::filesystem::path> files_of_series(const std::string& series) const;

  /// Gives every prepared file and series its name, the manifest last, and removes result files of an earlier
  /// run that this run did not write.
  void commit();

  /// The file that says what the others are: none is there while they change.
  static constexpr const char* manifest = "manifest.json";

 private:
  std::filesystem::path temporary(const std::string& name) const;
  void begin_series(const std::string& series);
  void commit_series();
  void discard() noexcept;

  std::filesystem::path path_;
  std::optional<folder_lock> lock_;
  std::vector<std::filesystem::path> made_;  ///< folders that did not exist before, outermost first
  std::vector<std::string> prepared_, series_;
  bool keep_ = false;
};

}  // namespace apsis
