#include <apsis/method/method_file.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/exact_form.hpp>
#include <apsis/method/internal/toml_section.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_text.hpp>

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>
#include <toml++/toml.h>

namespace apsis {
namespace {

method_kind read_kind(const toml_section& top) {
  const std::string text = top.text("kind");
  std::vector<std::string> names;
  for (const auto kind : all_method_kinds) {
    names.push_back(to_string(kind));
    if (names.back() == text) return kind;
  }
  top.fail("kind", fmt::format("unknown kind '{}' (there is no such kind); {}", text.substr(0, 40),
                               suggest(text, names)));
}

method_claims read_claims(const toml::table& root, const std::string& file) {
  const toml_section table(
      need_table(root, "claims", file), file, "claims",
      {"order", "ssp_coefficient", "type", "explicit_radius", "l_stable", "intermediate"});
  method_claims claims;
  claims.order = table.integer("order", 1, 8);
  if (table.has("type")) {
    claims.type = table.text("type");
    const std::vector<std::string> types = {"A", "ARS", "CK"};
    if (std::find(types.begin(), types.end(), *claims.type) == types.end())
      table.fail("type", fmt::format("unknown type '{}'; {}", claims.type->substr(0, 40),
                                     suggest(*claims.type, types)));
  }
  if (table.has("ssp_coefficient")) {
    claims.ssp_coefficient = table.text("ssp_coefficient");
    if (*claims.ssp_coefficient != "unconditional" && !is_coefficient(*claims.ssp_coefficient))
      table.fail(
          "ssp_coefficient",
          "'claims.ssp_coefficient' is neither a number in quotes nor \"unconditional\"; give one of them");
  }
  if (table.has("explicit_radius")) claims.explicit_radius = table.coefficient("explicit_radius");
  if (table.has("l_stable")) claims.l_stable = table.boolean("l_stable");
  if (table.has("intermediate")) {
    claims.intermediate = table.text("intermediate");
    const std::vector<std::string> kinds = {"slow", "all"};
    if (std::find(kinds.begin(), kinds.end(), *claims.intermediate) == kinds.end())
      table.fail("intermediate",
                 fmt::format("unknown claim '{}' (there is no such claim); {}",
                             claims.intermediate->substr(0, 40), suggest(*claims.intermediate, kinds)));
  }
  return claims;
}

const std::vector<std::string> all_keys = {"name",  "title",  "citation",  "origin",  "purpose", "kind",
                                           "steps", "claims", "shu_osher", "butcher", "embedded"};

void read_shu_osher(const toml::table& table, const std::string& file, method& m) {
  const bool is_explicit = m.kind == method_kind::explicit_only;
  std::vector<std::string> keys = {"P"};
  if (m.kind != method_kind::implicit_only) keys.insert(keys.end(), {"W", "r"});
  if (!is_explicit) keys.emplace_back("d");
  if (has_derivatives(m.kind)) keys.emplace_back("ddot");
  const toml_section form(table, file, "shu_osher", keys);
  const std::size_t s = form.row_count("P");
  auto& e = m.exact;
  e.P = e.W = e.D = zero_coefficients(s);
  e.ddot.assign(s, "0");
  e.r = "1";
  form.triangle("P", 0, e.P);
  if (m.kind != method_kind::implicit_only) {
    form.triangle("W", 0, e.W);
    e.r = form.coefficient("r");
    if (!(coefficient_value(e.r) > 0))
      form.fail("r", "'shu_osher.r' is not positive (Euler steps have the length 1/r); give r > 0");
  }
  if (is_explicit) return;
  const auto per_stage = [&](const std::string& key) {
    auto values = form.vector(key);
    if (values.size() != s)
      form.fail(key,
                fmt::format("'shu_osher.{}' has {} entries (the method has {} stages); give one per stage",
                            key, values.size(), s));
    return values;
  };
  const auto d = per_stage("d");
  if (has_derivatives(m.kind)) e.ddot = per_stage("ddot");
  for (std::size_t i = 0; i < s; ++i) {
    if (solves_exactly(m.kind) && coefficient_value(d[i]) < 0)
      form.fail("d", fmt::format("'shu_osher.d' has the entry {} (collisions cannot be solved backwards in "
                                 "time); give times >= 0",
                                 d[i]));
    e.D(i, i) = d[i];
  }
}

/// Reads [embedded], a row of the Shu–Osher form with the explicit and implicit parts that the method has.
void read_embedded(const toml::table& table, const std::string& file, method& m) {
  std::vector<std::string> keys = {"order", "origin", "convex", "P"};
  if (m.kind != method_kind::implicit_only) keys.emplace_back("W");
  if (m.kind != method_kind::explicit_only) keys.insert(keys.end(), {"d", "ddot"});
  const toml_section form(table, file, "embedded", keys);
  embedded_row row;
  row.order = form.integer("order", 1, 8);
  if (form.has("origin")) row.origin = form.text("origin");
  if (form.has("convex")) row.convex = form.boolean("convex");
  const auto weights = [&](const std::string& key) {
    auto values = form.vector(key);
    if (values.size() != m.stages())
      form.fail(
          key, fmt::format("'embedded.{}' has {} entries (the method has {} stages); give one per stage", key,
                           values.size(), m.stages()));
    return values;
  };
  row.P = weights("P");
  row.W = form.has("W") ? weights("W") : std::vector<std::string>(m.stages(), "0");
  if (form.has("d")) row.d = form.coefficient("d");
  if (form.has("ddot")) row.ddot = form.coefficient("ddot");
  m.embedded = row;
}

/// Reads [embedded] of a tableau, ũ = u^n + Δt Σ_j b̃_j (T(u_j) + Q(u_j)), as a row with r = 1.
void read_embedded_weights(const toml::table& table, const std::string& file, method& m) {
  const std::string key = "b_hat";
  const toml_section form(table, file, "embedded", {"order", "origin", key});
  const bool is_explicit = m.kind == method_kind::explicit_only;
  if (!is_explicit && !(m.kind == method_kind::imex && m.is_tableau()))
    form.fail(
        "order",
        "[embedded] of this [butcher] cannot be read (it is neither explicit nor an IMEX tableau); give the "
        "method as [shu_osher], or leave [embedded] out: steps are then doubled");
  if (coefficient_value(m.exact.r) != 1)
    form.fail(
        "order",
        "[embedded] of this [butcher] cannot be read (the method has an SSP coefficient and another form); "
        "give the method as [shu_osher], or leave [embedded] out: steps are then doubled");
  embedded_row row;
  row.order = form.integer("order", 1, 8);
  if (form.has("origin")) row.origin = form.text("origin");
  row.convex = false;
  row.W = form.vector(key);
  if (row.W.size() > m.stages())
    form.fail(key,
              fmt::format("'embedded.{}' has {} entries (the method has {} stages); give at most that many",
                          key, row.W.size(), m.stages()));
  row.W.resize(m.stages(), "0");
  for (const auto& weight : row.W) row.P.push_back(negated(weight));
  m.embedded = row;
}

/// Reads the rows of `key` and, if u^{n+1} is not the last stage, appends the row `weights` of the update.
matrix<std::string> read_tableau(const toml_section& form, const std::string& key, const std::string& weights,
                                 std::size_t diagonal, std::size_t s, bool update) {
  auto stages = zero_coefficients(s);
  form.triangle(key, diagonal, stages);
  if (!update) return stages;
  auto all = zero_coefficients(s + 1);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) all(i, j) = stages(i, j);
  const auto b = form.vector(weights);
  if (b.size() != s)
    form.fail(weights,
              fmt::format("'butcher.{}' has {} entries (the method has {} stages); give one per stage",
                          weights, b.size(), s));
  for (std::size_t j = 0; j < s; ++j) all(s, j) = b[j];
  return all;
}

/// Whether the weights of the update repeat the last stage, so that u^{n+1} is that stage.
bool repeats_last_stage(const butcher_form<std::string>& b) {
  const std::size_t last = b.stages() - 1;
  for (const auto* part : {&b.A_hat, &b.A, &b.A_dot})
    for (std::size_t j = 0; j < last; ++j)
      if (coefficient_value((*part)(last, j)) != coefficient_value((*part)(last - 1, j))) return false;
  return true;
}

/// Reads the Butcher form and derives the convex form, if there is one.
void read_butcher(const toml::table& table, const std::string& file, method& m) {
  const bool is_explicit = m.kind == method_kind::explicit_only;
  std::vector<std::string> keys;
  if (m.kind != method_kind::implicit_only) keys.insert(keys.end(), {"A_hat", "b_hat"});
  if (!is_explicit) keys.insert(keys.end(), {"A", "b", "A_dot", "b_dot"});
  const toml_section form(table, file, "butcher", keys);
  const std::string first = is_explicit ? "A_hat" : "A", weights = is_explicit ? "b_hat" : "b";
  const std::size_t s = form.row_count(first);
  const bool update = form.has("b_hat") || form.has("b") || form.has("b_dot");
  if (update && s == most_stages)
    form.fail(first, fmt::format("{} stages and an update are too many (at most {} rows); give fewer stages",
                                 s, most_stages));
  const std::size_t rows = update ? s + 1 : s;
  butcher_form<std::string> b{zero_coefficients(rows), zero_coefficients(rows), zero_coefficients(rows)};
  if (m.kind != method_kind::implicit_only) b.A_hat = read_tableau(form, "A_hat", "b_hat", 0, s, update);
  if (!is_explicit) b.A = read_tableau(form, "A", "b", 1, s, update);
  if (form.has("A_dot") || form.has("b_dot")) b.A_dot = read_tableau(form, "A_dot", "b_dot", 1, s, update);
  if (update && repeats_last_stage(b))
    form.fail(weights,
              fmt::format(
                  "'butcher.{}' repeats the last stage (then u^{{n+1}} is that stage); leave the update out",
                  weights));
  std::string reason;
  const auto exact = exact_shu_osher(b, m.kind, reason);
  if (!exact)
    form.fail(first, fmt::format("[butcher] cannot be read (no convex Shu-Osher form: {}, and Qdot of a "
                                 "stage enters another one but not the stage itself); "
                                 "give [shu_osher]",
                                 reason));
  m.exact = *exact;
}

/// Throws input_error unless the first row of a two-step method is 0: it stands for u^{n−1}, which is given.
void require_given_row(const toml::table& root, const std::string& file, const method& m) {
  const toml_section top(root, file, "", all_keys);
  if (m.kind != method_kind::imex || !top.has("shu_osher") || top.has("embedded"))
    top.fail("steps",
             "a two-step method cannot be read (it is given by [shu_osher] with kind = \"imex\" and has no "
             "[embedded]); change it");
  const auto& e = m.exact;
  if (coefficient_value(e.D(0, 0)) != 0 || coefficient_value(e.ddot[0]) != 0)
    top.fail(
        "steps",
        "the first row of a two-step method is not 0 (it stands for u^{n-1}, which is given); set its d and "
        "ddot to 0");
}

void check_exact_collisions(const toml_section& top, method_kind kind) {
  if (top.has("butcher"))
    top.fail(
        "butcher",
        fmt::format("an {} method has no [butcher] (its stages are exact solutions of the collision); give "
                    "[shu_osher]",
                    to_string(kind)));
  if (top.has("embedded"))
    top.fail("embedded",
             fmt::format("an {} method has no [embedded] (its error is not estimated); leave it out",
                         to_string(kind)));
}

}  // namespace

method parse_any_method(std::string_view text, const std::string& file) {
  check_method_text(text, file);
  toml::table root;
  try {
    root = toml::parse(text, file);
  } catch (const toml::parse_error& failure) {
    const auto& at = failure.source().begin;
    throw input_error({file, static_cast<int>(at.line), static_cast<int>(at.column)},
                      "not TOML (" + std::string(failure.description()) + "); correct the syntax");
  }
  method m;
  const toml_section top(root, file, "", all_keys);
  m.name = top.text("name");
  if (const auto problem = method_name_problem(m.name); !problem.empty()) top.fail("name", problem);
  m.title = top.text("title");
  m.citation = top.text("citation");
  if (top.has("origin")) m.origin = top.text("origin");
  if (top.has("purpose")) m.purpose = top.text("purpose");
  m.kind = read_kind(top);
  if (top.has("steps")) m.steps = top.integer("steps", 1, 2);
  m.claims = read_claims(root, file);
  if (solves_exactly(m.kind)) check_exact_collisions(top, m.kind);
  if (top.has("shu_osher") == top.has("butcher"))
    throw input_error(source_place{file, 1, 1},
                      "the coefficients are missing or given twice (a method has either [shu_osher] or "
                      "[butcher]); give one of them");
  if (top.has("shu_osher")) {
    read_shu_osher(need_table(root, "shu_osher", file), file, m);
  } else {
    read_butcher(need_table(root, "butcher", file), file, m);
  }
  if (m.steps == 2) require_given_row(root, file, m);
  if (!top.has("embedded")) return m;
  const auto& embedded = need_table(root, "embedded", file);
  if (top.has("shu_osher"))
    read_embedded(embedded, file, m);
  else
    read_embedded_weights(embedded, file, m);
  return m;
}

method parse_method(std::string_view text, const std::string& file) {
  method m = parse_any_method(text, file);
  if (m.steps == 2)
    throw input_error(
        source_place{file, 1, 1},
        fmt::format("'{}' takes two steps (steps = 2: equal ones, with the integrator apsis::two_step); "
                    "choose a method of one step",
                    m.name));
  return m;
}

}  // namespace apsis
