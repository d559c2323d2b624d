#pragma once

#include <apsis/method/tableau.hpp>
#include <apsis/method/trees.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// What a method integrates, and so which order conditions it must satisfy.
enum class method_kind {
  implicit_only,  ///< u' = Q(u): no transport (trees of one colour)
  imex,           ///< u' = T(u) + Q(u): T explicit, Q implicit (trees of two colours)
  explicit_only   ///< u' = T(u) + Q(u), both explicit with the same coefficients, A = Â
};

/// "implicit", "imex" or "explicit".
std::string to_string(method_kind kind);

/// The trees whose order conditions a method of this kind must satisfy.
tree_colours colours_of(method_kind kind);

/// What the file of a method says about it; certified when it is loaded.
struct method_claims {
  int order = 0;                               ///< p, no higher
  std::optional<std::string> ssp_coefficient;  ///< as written; "unconditional" for implicit methods
  std::optional<std::string> type;             ///< "A", "ARS" or "CK"
  std::optional<std::string>
      explicit_radius;           ///< as written; of the explicit part of an IMEX method by itself
  std::optional<bool> l_stable;  ///< of the implicit part
  std::optional<std::string>
      intermediate;  ///< O(ε) terms that are right where ε ≪ Δt: "slow" (N1, N2) or "all" (N1–N3)
};

/// One more row of the Shu–Osher form, a solution ũ of lower order beside u^{n+1} from which the error of a
/// step is estimated:
///   ũ = r̃ u^n + Σ_j p̃_j u_j + Σ_j w̃_j (u_j + (Δt/r) T(u_j)) + Δt d̃ Q(ũ) + Δt² d̃̇ Q̇(ũ),
///   r̃ = 1 − Σ_j (p̃_j + w̃_j),
/// with the r of the method, j over all its stages. With all weights and d̃ ≥ 0 and d̃̇ ≤ 0 it keeps what the
/// stages keep. Coefficients as strings, as those of the method.
struct embedded_row {
  int order = 0;               ///< q, below that of the method
  std::string origin;          ///< how it was found; "" if nothing is said
  std::vector<std::string> P,  ///< p̃, as many as stages
      W;                       ///< w̃, likewise
  std::string d = "0",         ///< d̃
      ddot = "0";              ///< d̃̇, with its sign
};

/// A time integrator as data. Coefficients exist as the strings of its file (exact rationals "p/q" or
/// decimals of any length) and are converted to the precision in which they are asked for.
class method {
 public:
  std::string name,                      ///< as in its file, or of the member of a family
      title,                             ///< one line
      citation;                          ///< where it was published
  std::string origin;                    ///< how its coefficients were found; "" where the citation says it
  std::string purpose;                   ///< what it is recommended for, in a few words; "" where it is not
  method_kind kind = method_kind::imex;  ///< which equations it integrates
  method_claims claims;                  ///< what certify() checks
  shu_osher_form<std::string> exact;     ///< as in the file; "0" where nothing stands
  std::optional<embedded_row> embedded;  ///< of methods that have one

  /// Rows of the form, the last of which is u^{n+1}.
  std::size_t stages() const { return exact.stages(); }

  /// u^{n+1} is no stage but an update, u^n + Δt Σ b̂_j T(u_j) + Δt Σ b_j Q(u_j): the last row has no implicit
  /// part although the method has one.
  bool ends_with_update() const;

  /// Q of a stage enters a later one (D has entries below the diagonal): outside the paper's class.
  bool is_tableau() const;

  /// Decimals of the longest coefficient that is not an exact rational or a short decimal; 0 if all are
  /// exact.
  int precision() const;

  /// The method of s + 1 rows whose result is the embedded solution: its order is claimed, nothing else. Only
  /// if there is an embedded row.
  method with_embedded_row() const;

  /// Shu–Osher form in `Real` (double, long double or mp_real), each coefficient correctly rounded
  /// from its exact value. In double and long double the convex weights are then set on a common
  /// grid so that r_i + Σ_j (p_ij + w_ij) is 1 without rounding and no step drifts.
  template <class Real>
  shu_osher_form<Real> coefficients() const;
};

/// The method called `name`: of the catalogue (methods/*.toml), a member of a family (family_registry.hpp),
/// or a file of the user, FILE.toml; certified. The file is read at every call and certified again when its
/// text has changed; references returned before stay valid. Throws input_error with the nearest name if there
/// is none, or the range of S if a family has no such member, claim_error if its claims do not hold, and
/// io_error.
const method& find_method(std::string_view name);

/// The same method. Throws input_error with the names of those of the catalogue that have one if it has no
/// embedded row.
const method& require_embedded_row(const method& m);

/// Names of the catalogue, sorted; without members of families.
std::vector<std::string> method_names();

/// Whether `name` is in the catalogue or has the pattern of a family.
bool is_method_name(std::string_view name);

/// A method from the text of a file. `file` is for messages only. Does not certify.
/// Throws input_error with line and column.
method parse_method(std::string_view text, const std::string& file);

/// Reads, parses and certifies a file of the user. Throws input_error, io_error or claim_error.
method load_method_file(const std::string& path);

}  // namespace apsis
