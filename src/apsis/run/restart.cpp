#include <apsis/run/restart.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/output/sealed_file.hpp>
#include <apsis/run/distribution_rows.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/shared_files.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace apsis {
namespace {

[[noreturn]] void refuse_size(const std::string& path, const checkpoint& saved, int cells, int components) {
  throw input_error(fmt::format(
      "'{}' holds {} x {} unknowns (the case has {} x {}); restart with the case it was written for", path,
      saved.cells, saved.components, cells, components));
}

void warn_of_another_commit(const checkpoint& saved, const std::string& path) {
  const std::string here = commit();
  if (saved.commit == here || saved.commit == "unknown" || here == "unknown") return;
  log::warning(fmt::format(
      "'{}' was written by commit {} of version {} (this is {}; the results may differ in their last "
      "digits); run the case again from its beginning where that matters",
      path, saved.commit, version(), here));
}

// Returns the case as text, without keys that may differ between a run and its continuation: they
// do not enter a step.
std::string essential_text(case_config config) {
  config.title.clear();
  config.output = {};
  config.time.end = 1.0;
  config.space.blocks.reset();
  if (config.steady_state.tolerance) config.steady_state = {.tolerance = usual_steady_tolerance};
  return to_toml(config);
}

void check_same_case(const case_config& mine, const std::string& saved_text, const std::string& path) {
  const auto [here, there] =
      first_difference(essential_text(mine), essential_text(parse_case(saved_text, path)));
  if (here != there)
    throw input_error(fmt::format(
        "'{}' belongs to another case ('{}' there, '{}' here); restart with the case it was written for",
        path, there, here));
}

/// Whether the file may be a damaged checkpoint or another HDF5 file: it is empty, or begins as one of them.
bool may_be_hdf5(const std::string& path) {
  const std::string signature = "\x89HDF\r\n\x1a\n";
  std::string begin(seal_length + signature.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return file.gcount() == 0 || begin.starts_with("apsis ") || begin.starts_with(signature) ||
         begin.ends_with(signature);
}

}  // namespace

void check_is_checkpoint(const std::string& path) {
  const char* const advice = "give a checkpoint.h5 written by apsis";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw input_error(fmt::format("no checkpoint '{}' (there is no such file); {}", path, advice));
  if (std::filesystem::is_directory(path, ignored)) {
    const auto inside = std::filesystem::path(path) / "checkpoint.h5";
    const bool found = std::filesystem::exists(inside, ignored);
    throw input_error(fmt::format("'{}' is not a checkpoint (it is a folder); {}", path,
                                  found ? "give " + inside.string() : advice));
  }
  if (!may_be_hdf5(path))
    throw input_error(fmt::format("'{}' is not a checkpoint (it is not an HDF5 file); {}", path, advice));
}

std::pair<std::string, std::string> first_difference(const std::string& a, const std::string& b) {
  std::istringstream of_a(a), of_b(b);
  for (;;) {
    std::pair<std::string, std::string> lines;
    const bool more = static_cast<bool>(std::getline(of_a, lines.first));
    if (!std::getline(of_b, lines.second) && !more) return lines;
    if (lines.first != lines.second) return lines;
  }
}

case_config with_method_of(const std::optional<std::string>& path, case_config config,
                           communicator& processes) {
  if (!path || config.time.method_reason.empty()) return config;
  std::string text;
  run_collectively(processes, [&] {
    if (processes.is_root()) text = read_case_of_checkpoint(*path);
  });
  broadcast_text(processes, text);
  const std::string before = parse_case(text, *path).time.method;
  if (before == config.time.method) return config;
  config.time.method = before;
  config.time.method_reason = "the method of the checkpoint";
  return config;
}

checkpoint read_by_all(const std::string& path, communicator& processes,
                       const std::optional<dataset_part>& part) {
  checkpoint saved;
  run_collectively(processes, [&] {
    if (processes.is_root()) saved = read_checkpoint(path, part);
  });
  run_collectively(processes, [&] {
    if (!processes.is_root()) saved = read_checkpoint(path, part, false);
  });
  return saved;
}

state_source state_of_checkpoint(const std::string& path) {
  return [path](const run_setup& setup) {
    const grid& block = setup.mesh();
    std::optional<dataset_part> part;
    if (!setup.processes().is_single()) part = part_of(block);
    const checkpoint saved = read_by_all(path, setup.processes(), part);
    field u(block.size(), setup.equation->components());
    const auto components = static_cast<std::size_t>(u.components());
    if (saved.state.size() != static_cast<std::size_t>(u.cells()) * components)
      refuse_size(path, saved, setup.whole_mesh().size(), u.components());
    for (int cell = 0; cell < u.cells(); ++cell)
      std::copy_n(saved.state.begin() + static_cast<std::ptrdiff_t>(cell) * u.components(), u.components(),
                  u.row(cell));
    return u;
  };
}

void check_checkpoint(const checkpoint& saved, const std::string& path, const simulation& run) {
  warn_of_another_commit(saved, path);
  check_same_case(run.config(), saved.case_text, path);
  const int cells = run.mesh().size(), components = run.setup().equation->components();
  if (saved.cells != static_cast<std::uint64_t>(cells) ||
      saved.components != static_cast<std::uint64_t>(components))
    refuse_size(path, saved, cells, components);
}

}  // namespace apsis
