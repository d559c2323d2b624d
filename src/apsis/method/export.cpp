#include <apsis/method/export.hpp>

#include <apsis/method/coefficient.hpp>

#include <algorithm>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

bool is_zero(const std::string& text) {
  return coefficient_value(text) == 0;
}

/// Returns a TOML basic string with special characters escaped.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20 || code == 0x7f) {
      out += fmt::format("\\u{:04x}", code);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string list(const std::vector<std::string>& values) {
  std::vector<std::string> texts;
  for (const auto& value : values) texts.push_back(quoted(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// Returns the first `count` entries of row i.
std::vector<std::string> entries(const matrix<std::string>& m, std::size_t i, std::size_t count) {
  std::vector<std::string> row;
  for (std::size_t j = 0; j < count; ++j) row.push_back(m(i, j));
  return row;
}

/// Formats the rows of a lower triangular matrix; `diagonal` is 1 to include the diagonal and 0 to omit it.
std::string triangle(const matrix<std::string>& m, std::size_t diagonal, std::size_t rows) {
  std::string out = "[\n";
  for (std::size_t i = 0; i < rows; ++i) out += "  " + list(entries(m, i, i + diagonal)) + ",\n";
  return out + "]";
}

bool has_derivative(const method& m) {
  return !std::all_of(m.exact.ddot.begin(), m.exact.ddot.end(), is_zero);
}

/// Whether R = I, so that W = Â, D = A and Ȧ is diagonal.
bool is_sum_of_increments(const shu_osher_form<std::string>& form) {
  for (std::size_t i = 0; i < form.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (coefficient_value(form.P(i, j)) + coefficient_value(form.W(i, j)) != 0) return false;
  return true;
}

/// Returns the Butcher form of a tableau: its coefficients if R = I, and otherwise computed ones.
butcher_form<std::string> tableau_of(const method& m) {
  const std::size_t s = m.stages();
  butcher_form<std::string> texts{m.exact.W, m.exact.D, matrix<std::string>(s, s)};
  if (is_sum_of_increments(m.exact)) {
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t j = 0; j < s; ++j) texts.A_dot(i, j) = i == j ? m.exact.ddot[i] : "0";
    return texts;
  }
  const auto numbers = to_butcher(m.coefficients<mp_real>());
  const auto text = [&m](const mp_real& x) {
    return coefficient_text(x, m.precision() > 0 ? std::min(m.precision(), 50) : 50);
  };
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) {
      texts.A_hat(i, j) = text(numbers.A_hat(i, j));
      texts.A(i, j) = text(numbers.A(i, j));
      texts.A_dot(i, j) = text(numbers.A_dot(i, j));
    }
  return texts;
}

/// Formats the table [butcher] of a tableau.
std::string butcher_table(const method& m) {
  const auto b = tableau_of(m);
  const bool update = m.ends_with_update();
  const std::size_t rows = update ? m.stages() - 1 : m.stages();
  std::string out = "\n[butcher]\n";
  const auto part = [&](const char* name, const char* weights, const matrix<std::string>& a,
                        std::size_t diagonal) {
    out += fmt::format("{} = {}\n", name, triangle(a, diagonal, rows));
    if (update) out += fmt::format("{} = {}\n", weights, list(entries(a, rows, rows)));
  };
  if (m.kind == method_kind::imex) part("A_hat", "b_hat", b.A_hat, 0);
  part("A", "b", b.A, 1);
  if (has_derivative(m)) part("A_dot", "b_dot", b.A_dot, 1);
  return out;
}

std::vector<std::string> diagonal_of(const matrix<std::string>& m) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < m.rows(); ++i) values.push_back(m(i, i));
  return values;
}

std::string embedded_table(const embedded_row& row, method_kind kind) {
  std::string out =
      fmt::format("\n[embedded]\norder = {}\n{}", row.order, row.convex ? "" : "convex = false\n");
  if (!row.origin.empty()) out += fmt::format("origin = {}\n", quoted(row.origin));
  out += fmt::format("P = {}\n", list(row.P));
  if (kind != method_kind::implicit_only) out += fmt::format("W = {}\n", list(row.W));
  if (kind != method_kind::explicit_only)
    out += fmt::format("d = {}\nddot = {}\n", quoted(row.d), quoted(row.ddot));
  return out;
}

/// Formats the table [embedded] of a tableau. Its weights are those of T and of Q.
std::string embedded_weights(const embedded_row& row) {
  return fmt::format("\n[embedded]\norder = {}\n{}b_hat = {}\n", row.order,
                     row.origin.empty() ? "" : fmt::format("origin = {}\n", quoted(row.origin)), list(row.W));
}

/// Formats a number as LaTeX: "\frac{1}{2}", "0.25".
std::string number(const std::string& text, int digits) {
  const auto slash = text.find('/');
  if (is_zero(text)) return "0";
  if (slash == std::string::npos) return coefficient_value(text).str(digits);
  const std::size_t start = text[0] == '-' || text[0] == '+' ? 1 : 0;
  return fmt::format("{}\\frac{{{}}}{{{}}}", text[0] == '-' ? "-" : "", text.substr(start, slash - start),
                     text.substr(slash + 1));
}

/// Formats "name = (rows × cols array)" with the entries entry(row, column).
std::string array(const std::string& name, std::size_t rows, std::size_t cols,
                  const std::function<std::string(std::size_t, std::size_t)>& entry) {
  std::string out = fmt::format("{} &= \\left(\\begin{{array}}{{{}}}\n", name, std::string(cols, 'r'));
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<std::string> row;
    for (std::size_t j = 0; j < cols; ++j) row.push_back(entry(i, j));
    out += fmt::format("  {} \\\\\n", fmt::join(row, " & "));
  }
  return out + "\\end{array}\\right)";
}

/// Formats p̃, w̃, d̃ and d̃̇, one line each.
std::vector<std::string> embedded_parts(const embedded_row& row, method_kind kind, int digits) {
  const auto of = [digits](const std::vector<std::string>& values) {
    return [&values, digits](std::size_t, std::size_t j) { return number(values[j], digits); };
  };
  std::vector<std::string> parts = {array("\\tilde p", 1, row.P.size(), of(row.P))};
  if (kind != method_kind::implicit_only) parts.push_back(array("\\tilde w", 1, row.W.size(), of(row.W)));
  parts.push_back("\\tilde d &= " + number(row.d, digits));
  parts.push_back("\\tilde{\\dot d} &= " + number(row.ddot, digits));
  return parts;
}

}  // namespace

std::string to_toml(const method& m) {
  std::string out = fmt::format("name = {}\ntitle = {}\ncitation = {}\n", quoted(m.name), quoted(m.title),
                                quoted(m.citation));
  if (!m.origin.empty()) out += fmt::format("origin = {}\n", quoted(m.origin));
  if (!m.purpose.empty()) out += fmt::format("purpose = {}\n", quoted(m.purpose));
  if (m.steps != 1) out += fmt::format("steps = {}\n", m.steps);
  out += fmt::format("kind = {}\n\n[claims]\norder = {}\n", quoted(to_string(m.kind)), m.claims.order);
  if (m.claims.ssp_coefficient)
    out += fmt::format("ssp_coefficient = {}\n", quoted(*m.claims.ssp_coefficient));
  if (m.claims.type) out += fmt::format("type = {}\n", quoted(*m.claims.type));
  if (m.claims.explicit_radius)
    out += fmt::format("explicit_radius = {}\n", quoted(*m.claims.explicit_radius));
  if (m.claims.l_stable) out += fmt::format("l_stable = {}\n", *m.claims.l_stable);
  if (m.claims.intermediate) out += fmt::format("intermediate = {}\n", quoted(*m.claims.intermediate));
  if (m.is_tableau()) return out + butcher_table(m) + (m.embedded ? embedded_weights(*m.embedded) : "");
  out += "\n[shu_osher]\n";
  if (m.kind != method_kind::implicit_only) out += fmt::format("r = {}\n", quoted(m.exact.r));
  out += fmt::format("P = {}\n", triangle(m.exact.P, 0, m.stages()));
  if (m.kind != method_kind::implicit_only)
    out += fmt::format("W = {}\n", triangle(m.exact.W, 0, m.stages()));
  if (m.kind != method_kind::explicit_only) out += fmt::format("d = {}\n", list(diagonal_of(m.exact.D)));
  if (has_derivatives(m.kind)) out += fmt::format("ddot = {}\n", list(m.exact.ddot));
  return m.embedded ? out + embedded_table(*m.embedded, m.kind) : out;
}

std::string to_latex(const method& m, int digits) {
  const std::size_t s = m.stages();
  const auto& e = m.exact;
  const auto of = [&](const matrix<std::string>& values) {
    return [&values, digits](std::size_t i, std::size_t j) {
      return j > i ? "0" : number(values(i, j), digits);
    };
  };
  std::vector<std::string> parts;
  if (m.is_tableau()) {
    const auto b = tableau_of(m);
    if (m.kind == method_kind::imex) parts.push_back(array("\\hat A", s, s, of(b.A_hat)));
    parts.push_back(array("A", s, s, of(b.A)));
    if (has_derivative(m)) parts.push_back(array("\\dot A", s, s, of(b.A_dot)));
  } else {
    if (m.kind != method_kind::implicit_only) parts.push_back("r &= " + number(e.r, digits));
    parts.push_back(array("P", s, s, of(e.P)));
    if (m.kind != method_kind::implicit_only) parts.push_back(array("W", s, s, of(e.W)));
    if (m.kind != method_kind::explicit_only)
      parts.push_back(
          array("d", s, 1, [&](std::size_t i, std::size_t) { return number(e.D(i, i), digits); }));
    if (has_derivatives(m.kind))
      parts.push_back(
          array("\\dot d", s, 1, [&](std::size_t i, std::size_t) { return number(e.ddot[i], digits); }));
  }
  if (m.embedded)
    for (auto& part : embedded_parts(*m.embedded, m.kind, digits)) parts.push_back(std::move(part));
  return fmt::format("% {}: {}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n", m.name, m.title,
                     fmt::join(parts, " \\\\\n"));
}

}  // namespace apsis
