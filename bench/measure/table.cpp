#include "table.hpp"

#include <apsis/exec/instruction_set.hpp>
#include <apsis/output/provenance.hpp>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <sstream>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

namespace apsis::bench {
namespace {

std::vector<entry>& all() {
  static std::vector<entry> list;
  return list;
}

std::string cell_text(const nlohmann::json& cell) {
  if (cell.is_string()) return cell.get<std::string>();
  if (cell.is_number_integer()) return std::to_string(cell.get<long>());
  if (cell.is_number()) return fmt::format("{:.3g}", cell.get<double>());
  return "—";
}

}  // namespace

registered::registered(entry what) {
  all().push_back(std::move(what));
}

std::vector<entry> entries() {
  auto list = all();
  std::sort(list.begin(), list.end(), [](const entry& a, const entry& b) { return a.name < b.name; });
  return list;
}

std::vector<std::string> left_out() {
  std::istringstream names(APSIS_BENCH_LEFT_OUT);
  return {std::istream_iterator<std::string>(names), {}};
}

std::string markdown(const result_table& what) {
  std::string text =
      fmt::format("**{}**\n\n{}\n\n| {} |\n|", what.title, what.note, fmt::join(what.columns, " | "));
  for (std::size_t k = 0; k < what.columns.size(); ++k) text += "---|";
  text += "\n";
  for (const auto& row : what.rows) {
    std::vector<std::string> cells;
    for (const auto& cell : row) cells.push_back(cell_text(cell));
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
  }
  return text;
}

nlohmann::json to_json(const result_table& what) {
  return {{"title", what.title},
          {"note", what.note},
          {"columns", what.columns},
          {"rows", what.rows},
          {"data", what.data}};
}

nlohmann::json machine() {
  const auto cache = [](int name) { return sysconf(name) / 1024; };
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return {{"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", now)},
          {"processor", machine_info()["processor"]},
          {"cores", std::thread::hardware_concurrency()},
          {"cache_kib",
           {{"L1", cache(_SC_LEVEL1_DCACHE_SIZE)},
            {"L2", cache(_SC_LEVEL2_CACHE_SIZE)},
            {"L3", cache(_SC_LEVEL3_CACHE_SIZE)}}},
          {"kernels", kernel_instruction_set()},
          {"compiler", APSIS_BENCH_COMPILER},
          {"flags", APSIS_BENCH_FLAGS},
          {"version", APSIS_BENCH_VERSION}};
}

}  // namespace apsis::bench
