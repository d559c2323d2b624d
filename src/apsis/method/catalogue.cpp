#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/integrator_kind_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_file.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

struct entry {
  method parsed;
  certificate of_claims;                   ///< certificate_scope::claims
  std::unique_ptr<certificate> certified;  ///< complete, from the first call of find_certificate()
};

/// Whether two methods have the same kind and equal values of all coefficients. Embedded rows are not
/// compared.
bool is_same(const method& a, const method& b) {
  const auto x = a.coefficients<mp_real>(), y = b.coefficients<mp_real>();
  const auto equal = [](const matrix<mp_real>& one, const matrix<mp_real>& other) {
    if (one.rows() != other.rows()) return false;
    for (std::size_t i = 0; i < one.rows(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        if (one(i, j) != other(i, j)) return false;
    return true;
  };
  return a.kind == b.kind && equal(x.P, y.P) && equal(x.W, y.W) && equal(x.D, y.D) && x.ddot == y.ddot &&
         x.r == y.r;
}

/// Whether the text of a file of the catalogue has the line steps = 2. A complete parse of all files would
/// take longer than a short run.
bool takes_two_steps(std::string_view text) {
  return text.find("\nsteps = 2\n") != std::string_view::npos;
}

/// Returns the text of a method of the catalogue; nothing for other names.
std::optional<std::string_view> text_of(std::string_view name) {
  for (const auto& file : embedded::methods())
    if (file.name == name) return file.text;
  return std::nullopt;
}

/// Returns the text of a method of one step of the catalogue; nothing for other names.
std::optional<std::string_view> text_of_one_step(std::string_view name) {
  const auto text = text_of(name);
  return text && !takes_two_steps(*text) ? text : std::nullopt;
}

std::string place_of(std::string_view name) {
  return fmt::format("methods/{}.toml", name);
}

method parse_catalogue_method(std::string_view name) {
  if (const auto text = text_of_one_step(name)) return parse_method(*text, place_of(name));
  return make_member(*try_find_family(name), name);
}

/// Throws input_error if the name of a method from a file belongs to another method.
void require_own_name(const method& m, const std::string& path) {
  if (const auto problem = taken_name(m); !problem.empty())
    throw input_error(source_place{path, 0, 0}, problem);
}

/// Certifies a method and gives its embedded row the weight from the certificate.
certificate certify_and_complete(method& m) {
  certificate c = certify(m, certificate_scope::claims);
  if (m.embedded && c.embedded) m.embedded->weight = c.embedded->weight;
  return c;
}

/// Makes a method of the catalogue or a member of a family. Throws input_error for an unknown name.
method make_named_method(std::string_view name) {
  if (const auto file = text_of_one_step(name)) return parse_method(*file, place_of(name));
  if (const family_entry* family = try_find_family(name)) return make_member(*family, name);
  std::vector<std::string> known = method_names();
  for (const family_entry* family : family_entries()) known.push_back(family->pattern);
  const std::string text(name.substr(0, 60));
  const auto of_several_steps = names_of_several_steps();
  if (std::find(of_several_steps.begin(), of_several_steps.end(), text) != of_several_steps.end())
    throw input_error(
        "'" + text +
        "' is a multistep method (a method of one step is needed here); see: apsis list methods");
  throw input_error("unknown method '" + text + "' (there is no such name); " + suggest(text, known));
}

std::mutex& entries_guard() {
  static std::mutex guard;
  return guard;
}

/// Parses a method, certifies its claims on first use and caches both. A method file is cached by path and
/// contents, so that a changed file is certified again. Entries of earlier contents stay, because callers
/// hold references to them.
entry& find_entry(const std::string& name) {
  static std::map<std::pair<std::string, std::string>, std::unique_ptr<entry>> known;
  const bool is_file = is_method_file(name);
  std::pair key(name, is_file ? read_method_text(name) : std::string());
  const std::lock_guard lock(entries_guard());
  const auto found = known.find(key);
  if (found != known.end()) return *found->second;
  auto made = std::make_unique<entry>();
  made->parsed = is_file ? parse_method(key.second, name) : make_named_method(name);
  made->of_claims = certify_and_complete(made->parsed);
  if (is_file && made->of_claims.claims_hold) require_own_name(made->parsed, name);
  return *known.emplace(std::move(key), std::move(made)).first->second;
}

}  // namespace

const method& find_method(std::string_view name) {
  const entry& found = find_entry(std::string(name));
  require_claims(found.of_claims);
  return found.parsed;
}

const certificate& find_certificate(const std::string& name) {
  entry& found = find_entry(name);
  const std::lock_guard lock(entries_guard());
  if (!found.certified) found.certified = std::make_unique<certificate>(certify(found.parsed));
  return *found.certified;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& file : embedded::methods())
    if (!takes_two_steps(file.text)) names.emplace_back(file.name);
  return names;
}

bool is_method_name(std::string_view name) {
  return text_of_one_step(name) || try_find_family(name) != nullptr;
}

std::vector<std::string> names_of_several_steps() {
  std::vector<std::string> names;
  for (const integrator_kind_entry* kind : integrator_kind_entries())
    if (kind->formulas != nullptr)
      for (auto& name : kind->formulas()) names.push_back(std::move(name));
  for (const auto& file : embedded::methods())
    if (takes_two_steps(file.text)) names.emplace_back(file.name);
  return names;
}

std::vector<std::string> integrator_names() {
  auto names = method_names();
  for (auto& name : names_of_several_steps()) names.push_back(std::move(name));
  return names;
}

std::vector<std::string> integrator_names(const std::string& kind) {
  auto names = integrator_names();
  std::erase_if(names, [&kind](const auto& name) { return find_integrator(name).kind != kind; });
  return names;
}

std::unique_ptr<time_integrator> integrator_of_file(method file) {
  for (const integrator_kind_entry* kind : integrator_kind_entries())
    if (kind->reads != nullptr && kind->reads(file)) return kind->of_file(std::move(file));
  throw input_error(fmt::format("'{}' is of no kind of integrator; change 'kind' or 'steps'", file.name));
}

namespace {

/// Makes and certifies an integrator. If `name` is the path of a method file, `text` is its contents.
std::unique_ptr<time_integrator> make_integrator(const std::string& name, const std::string& text) {
  for (const integrator_kind_entry* kind : integrator_kind_entries()) {
    const auto formulas = kind->formulas != nullptr ? kind->formulas() : std::vector<std::string>();
    if (std::find(formulas.begin(), formulas.end(), name) != formulas.end()) return kind->of_formula(name);
  }
  const bool is_file = is_method_file(name);
  const auto of_catalogue = text_of(name);
  std::optional<method> parsed;
  if (is_file) parsed = parse_any_method(text, name);
  if (of_catalogue && takes_two_steps(*of_catalogue))
    parsed = parse_any_method(*of_catalogue, place_of(name));
  if (!parsed || parsed->steps == 1) return integrator_of_file(find_method(name));
  auto made = integrator_of_file(std::move(*parsed));
  const integrator_certificate c = made->certify();
  if (!c.claims_hold())
    throw claim_error(fmt::format("{} method '{}' does not meet its claims: {}", made->kind, made->name,
                                  fmt::join(c.failures, "; ")));
  return made;
}

}  // namespace

const time_integrator& find_integrator(const std::string& name) {
  static std::mutex guard;
  static std::map<std::pair<std::string, std::string>, std::unique_ptr<time_integrator>> known;
  std::pair key(name, is_method_file(name) ? read_method_text(name) : std::string());
  const std::lock_guard lock(guard);
  const auto found = known.find(key);
  if (found != known.end()) return *found->second;
  auto made = make_integrator(name, key.second);
  return *known.emplace(std::move(key), std::move(made)).first->second;
}

std::string taken_name(const method& m) {
  if (!is_method_name(m.name)) return "";
  const family_entry* family = try_find_family(m.name);
  const bool is_member = family != nullptr && missing_member(*family, m.name).empty();
  if (family != nullptr && !is_member)
    return fmt::format("the name '{}' is reserved (it has the pattern {} of a family); choose another name",
                       m.name, family->pattern);
  if (is_same(m, parse_catalogue_method(m.name))) return "";
  return fmt::format(
      "the name '{}' is taken (the catalogue has it with other coefficients, and results are filed under the "
      "name); choose another name",
      m.name);
}

bool is_method_file(std::string_view name) {
  return name.ends_with(".toml");
}

method load_method_file(const std::string& path) {
  method m = parse_method(read_method_text(path), path);
  require_claims(certify_and_complete(m));
  require_own_name(m, path);
  return m;
}

}  // namespace apsis
