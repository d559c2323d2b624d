#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_file.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

struct entry {
  method parsed;
  certificate certified;
};

/// From the file of the catalogue, by its family, or from a file of the user.
method make_method(std::string_view name) {
  if (is_method_file(name)) return parse_method(read_method_text(std::string(name)), std::string(name));
  for (const auto& file : embedded::methods())
    if (file.name == name) return parse_method(file.text, "methods/" + std::string(file.name) + ".toml");
  if (const family_entry* family = find_family(name)) return make_member(*family, name);
  std::vector<std::string> known = method_names();
  for (const family_entry* family : family_entries()) known.push_back(family->pattern);
  const std::string text(name.substr(0, 60));
  throw input_error("unknown method '" + text + "' " + suggest(text, known));
}

/// Made and certified when first asked for, then kept.
const entry& find_entry(std::string_view name) {
  static std::mutex guard;
  static std::map<std::string, std::unique_ptr<entry>, std::less<>> known;
  const std::lock_guard lock(guard);
  const auto found = known.find(name);
  if (found != known.end()) return *found->second;
  auto made = std::make_unique<entry>();
  made->parsed = make_method(name);
  made->certified = certify(made->parsed);
  return *known.emplace(std::string(name), std::move(made)).first->second;
}

}  // namespace

const method& find_method(std::string_view name) {
  const entry& found = find_entry(name);
  require_claims(found.certified);
  return found.parsed;
}

const certificate& find_certificate(const std::string& name) {
  return find_entry(name).certified;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& file : embedded::methods()) names.emplace_back(file.name);
  return names;
}

const method& require_embedded_row(const method& m) {
  if (m.embedded) return m;
  std::vector<std::string> names;
  for (const auto& file : embedded::methods())
    if (parse_method(file.text, std::string(file.name)).embedded) names.emplace_back(file.name);
  throw input_error(fmt::format("method '{}' has no embedded solution; choose one that has ({})", m.name,
                                fmt::join(names, ", ")));
}

bool is_method_name(std::string_view name) {
  for (const auto& file : embedded::methods())
    if (file.name == name) return true;
  return find_family(name) != nullptr;
}

bool is_method_file(std::string_view name) {
  return name.ends_with(".toml");
}

method load_method_file(const std::string& path) {
  method m = parse_method(read_method_text(path), path);
  require_claims(certify(m));
  return m;
}

}  // namespace apsis
