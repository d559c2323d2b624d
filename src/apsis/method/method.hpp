#pragma once

#include <apsis/method/tableau.hpp>
#include <apsis/method/trees.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// Class of equations that a method integrates. It determines the order conditions.
enum class method_kind {
  implicit_only,   ///< u' = Q(u): no transport (trees of one colour)
  imex,            ///< u' = T(u) + Q(u): T explicit, Q implicit (trees of two colours)
  explicit_only,   ///< u' = T(u) + Q(u), both explicit with the same coefficients, A = Â
  exact_collision  ///< u' = T(u) + Q(u): T explicit, Q by exact solutions (resolved_flows.hpp)
};

/// All kinds, in the order of tables.
inline constexpr std::array all_method_kinds = {method_kind::imex, method_kind::implicit_only,
                                                method_kind::explicit_only, method_kind::exact_collision};

/// Returns the name of a kind in files.
std::string to_string(method_kind kind);

/// Whether a method of this kind solves collisions exactly, instead of stages.
bool solves_exactly(method_kind kind);

/// Whether stages of a method of this kind may contain Q̇.
bool has_derivatives(method_kind kind);

/// Returns the colours of the trees whose order conditions a method of this kind must satisfy.
tree_colours colours_of(method_kind kind);

/// Claims of a method file. Loading the method verifies them.
struct method_claims {
  int order = 0;                               ///< p, exactly
  std::optional<std::string> ssp_coefficient;  ///< as written; "unconditional" for implicit methods
  std::optional<std::string> type;             ///< "A", "ARS" or "CK"
  std::optional<std::string>
      explicit_radius;           ///< as written; SSP coefficient of the explicit part of an IMEX method alone
  std::optional<bool> l_stable;  ///< whether the implicit part is L-stable
  std::optional<std::string>
      intermediate;  ///< O(ε) terms that are exact where ε ≪ Δt: "slow" (N1, N2) or "all" (N1–N3)
};

/// An additional row of the Shu–Osher form. Its solution ũ has a lower order than u^{n+1} and serves to
/// estimate the error of a step:
///   ũ = r̃ u^n + Σ_j p̃_j u_j + Σ_j w̃_j (u_j + (Δt/r) T(u_j)) + Δt d̃ Q(ũ) + Δt² d̃̇ Q̇(ũ),
///   r̃ = 1 − Σ_j (p̃_j + w̃_j),
/// where r is that of the method and j runs over all its stages. If all weights and d̃ are ≥ 0 and d̃̇ ≤ 0, ũ
/// preserves every convex property that the stages preserve. Coefficients are strings, like those of the
/// method.
struct embedded_row {
  int order = 0;               ///< q, below the order of the method
  std::string origin;          ///< how it was found; "" if not stated
  bool convex = true;          ///< whether all weights are ≥ 0; otherwise only d̃ ≥ 0 and d̃̇ ≤ 0 hold. False
                               ///< for a tableau: its W are the weights of T and of Q
  std::vector<std::string> P,  ///< p̃, one entry per stage
      W;                       ///< w̃, one entry per stage
  std::string d = "0",         ///< d̃
      ddot = "0";              ///< d̃̇, with its sign
  double weight = 1.0;  ///< factor of the estimated error, set by its certificate (embedded_certificate)
};

/// A time integrator as data. Coefficients are stored as the strings of the method file: exact rationals
/// "p/q" or decimals of up to 200 characters. coefficients() converts them to the precision requested.
class method {
 public:
  std::string name,                      ///< as in the method file, or that of a member of a family
      title,                             ///< one line
      citation;                          ///< publication
  std::string origin;                    ///< how its coefficients were found; "" if the citation states it
  std::string purpose;                   ///< its recommended use, in a few words, or ""
  method_kind kind = method_kind::imex;  ///< class of equations
  int steps = 1;                      ///< 2: the first row of `exact` stands for u^{n−1} (kinds/two_step.hpp)
  method_claims claims;               ///< verified by certify()
  shu_osher_form<std::string> exact;  ///< as in the file, omitted entries "0"
  std::optional<embedded_row> embedded;  ///< the embedded solution, if there is one

  /// Number of rows of the form; the last row is u^{n+1}.
  std::size_t stages() const { return exact.stages(); }

  /// Whether u^{n+1} is an explicit update instead of a stage: u^n + Δt Σ b̂_j T(u_j) + Δt Σ b_j Q(u_j). Its
  /// row has no implicit part, although the method has one.
  bool ends_with_update() const;

  /// Whether Q of a stage enters a later stage: D has entries below the diagonal. Such a method is outside
  /// the paper's class.
  bool is_tableau() const;

  /// Number of decimals of the longest inexact coefficient; 0 if all coefficients are exact (rationals
  /// and short decimals).
  int precision() const;

  /// Returns the method of s + 1 rows whose result is the embedded solution; only its order is claimed.
  /// Requires an embedded row.
  method with_embedded_row() const;

  /// Returns the Shu–Osher form in `Real` (double, long double or mp_real), each coefficient correctly
  /// rounded from its exact value. In double and long double the convex weights are then rounded to a common
  /// grid. r_i + Σ_j (p_ij + w_ij) is thus exactly 1 in floating point, and no step drifts.
  template <class Real>
  shu_osher_form<Real> coefficients() const;
};

/// Returns the certified method of one step called `name`. It is a method of the catalogue (methods/*.toml),
/// a member of a family (family_registry.hpp), or a method file given by its path, FILE.toml. A file is read
/// at every call and certified again when its contents have changed; references returned earlier stay valid.
/// Throws input_error with the closest name if there is no such method, or with the range of S if a family
/// has no such member. Throws claim_error if a claim fails, and io_error if a file cannot be read.
const method& find_method(std::string_view name);

/// Returns the names of the methods of one step of the catalogue, sorted; members of families are not listed.
std::vector<std::string> method_names();

/// Whether method_names() contains `name`, or `name` matches the pattern of a family.
bool is_method_name(std::string_view name);

/// Parses the text of a method file without certifying the method; `file` appears in messages. Throws
/// input_error with line and column, also for a method of two steps.
method parse_method(std::string_view text, const std::string& file);

/// Parses the text of a method file of one or two steps. Throws input_error with line and column.
method parse_any_method(std::string_view text, const std::string& file);

/// Reads, parses and certifies a method file. Throws input_error, io_error or claim_error.
method load_method_file(const std::string& path);

}  // namespace apsis
