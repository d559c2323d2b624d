#include "bad_input.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

namespace bad_input {

namespace {

std::vector<std::string> texts_of(const toml::table& table, const char* key) {
  std::vector<std::string> texts;
  if (const toml::array* list = table[key].as_array())
    for (const auto& one : *list) texts.push_back(one.value<std::string>().value());
  else if (const auto text = table[key].value<std::string>())
    texts.push_back(*text);
  return texts;
}

std::string changed(std::string text, const toml::table& given) {
  if (const auto from = given["from"].value<std::string>()) {
    const auto at = text.find(*from);
    if (at == std::string::npos) throw std::runtime_error("the case does not have '" + *from + "'");
    text.replace(at, from->size(), given["to"].value<std::string>().value());
  }
  return text + given["append"].value_or(std::string());
}

std::string place_of(const row& r, const std::optional<std::string>& given) {
  if (!given) {
    if (r.set.size() == 1) return "override '" + r.set.front() + "': ";
    if (!r.text.empty() && r.code != 0) throw std::runtime_error("the row has no place");
    return "";
  }
  const std::string& at = *given;
  if (at.empty()) return "";
  if (at == "override") return "override '";
  if (std::find(r.set.begin(), r.set.end(), at) != r.set.end()) return "override '" + at + "': ";
  return "c.toml:" + at + (at.back() == ':' ? "" : ": ");
}

row row_of(const toml::table& given, const std::string& text) {
  static const std::set<std::string, std::less<>> known = {"from", "to", "append", "set", "text",
                                                           "run",  "at", "says",   "code"};
  for (const auto& [key, value] : given)
    if (!known.contains(std::string(key))) throw std::runtime_error("unknown key " + std::string(key));
  row r;
  r.text = given["text"].value<std::string>().value_or(changed(text, given));
  r.set = texts_of(given, "set");
  r.run = texts_of(given, "run");
  r.says = texts_of(given, "says");
  r.code = given["code"].value_or(2);
  if (r.says.empty() != (r.code == 0)) throw std::runtime_error("either 'says' or code = 0 is needed");
  r.place = place_of(r, given["at"].value<std::string>());
  return r;
}

void add_rows_of(const toml::table& table, const std::string& file,
                 const std::function<std::string(const std::string&)>& text_of_case, std::vector<row>& rows) {
  const auto label = [&](const toml::node& node) {
    return file + ":" + std::to_string(node.source().begin.line);
  };
  const auto name = table["case"].value<std::string>();
  const std::string text = name ? text_of_case(*name) : table["text"].value_or(std::string());
  if (!text.empty()) {
    row valid;
    valid.label = label(table);
    valid.text = text;
    valid.code = 0;
    rows.push_back(valid);
  }
  for (const auto& node : *table["rows"].as_array()) {
    try {
      rows.push_back(row_of(*node.as_table(), text));
    } catch (const std::exception& problem) {
      throw std::runtime_error(label(node) + ": " + problem.what());
    }
    rows.back().label = label(node);
  }
}

}  // namespace

answer answer_of(const std::function<void()>& input) {
  try {
    input();
  } catch (const apsis::error& e) {
    return {static_cast<int>(e.code()), e.what()};
  }
  return {};
}

std::vector<row> rows_in(const std::string& path,
                         const std::function<std::string(const std::string&)>& text_of_case) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(path))
    for (const auto& entry : std::filesystem::directory_iterator(path)) files.push_back(entry.path());
  else
    files.emplace_back(path);
  std::sort(files.begin(), files.end());
  std::vector<row> rows;
  for (const auto& file : files) {
    const toml::table document = toml::parse_file(file.string());
    for (const auto& table : *document["table"].as_array())
      add_rows_of(*table.as_table(), file.filename().string(), text_of_case, rows);
  }
  return rows;
}

void expect_answers(const std::vector<row>& rows, const std::function<answer(const row&)>& ask) {
  for (const row& r : rows) {
    SCOPED_TRACE(r.label);
    const answer found = ask(r);
    EXPECT_EQ(found.code, r.code) << found.message;
    if (r.code == 0) continue;
    EXPECT_THAT(found.message, testing::StartsWith(r.place));
    for (const std::string& part : r.says) EXPECT_THAT(found.message, testing::HasSubstr(part));
    testing::Test::RecordProperty(r.label, found.message);
  }
}

void expect_refused(const std::vector<call>& calls, const std::source_location& place) {
  const std::string file = std::filesystem::path(place.file_name()).filename().string();
  for (std::size_t k = 0; k < calls.size(); ++k) {
    row r;
    r.label = file + ":" + std::to_string(place.line()) + "." + std::to_string(k + 1);
    r.says = calls[k].says;
    r.code = calls[k].code;
    expect_answers({r}, [&](const row&) { return answer_of(calls[k].input); });
  }
}

}  // namespace bad_input
