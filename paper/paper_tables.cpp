#include <paper/paper_tables.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/extremes.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace apsis::paper {
namespace {

using numbers = std::vector<double>;

numbers operator*(const numbers& a, const numbers& b) {
  numbers c(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) c[i] = a[i] * b[i];
  return c;
}

double inner(const numbers& a, const numbers& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

struct abscissae {
  explicit abscissae(const butcher_form<double>& t)
      : A_hat(t.A_hat), A(t.A), A_dot(t.A_dot), e(t.stages(), 1.0) {
    c = A * e;
    c_hat = A_hat * e;
    c_dot = A_dot * e;
    for (std::size_t j = 0; j < e.size(); ++j) {
      b.push_back(A(e.size() - 1, j));
      b_hat.push_back(A_hat(e.size() - 1, j));
      b_dot.push_back(A_dot(e.size() - 1, j));
    }
  }
  matrix<double> A_hat, A, A_dot;
  numbers e, c, c_hat, c_dot, b, b_hat, b_dot;
};

/// Returns the entries of the fourth-order method, whose values mostly occur in several rows of a column.
std::vector<printed_entry> fourth_order_entries(const std::array<double, 9>& x) {
  const auto& [x11, x41, x22, x32, x42, x33, x43, x44, x55] = x;
  return {{1, 1, x11}, {2, 1, x11}, {3, 1, x11}, {4, 1, x41}, {5, 1, x41},
          {2, 2, x22}, {3, 2, x32}, {4, 2, x42}, {5, 2, x42}, {3, 3, x33},
          {4, 3, x43}, {5, 3, x43}, {4, 4, x44}, {5, 4, x44}, {5, 5, x55}};
}

std::vector<printed_tableau> make_tableaux() {
  return {{"imdrk-2-3", {}, {{2, 2, 1.0}}, {{1, 1, -1.0 / 6}, {2, 1, -1.0 / 6}, {2, 2, -1.0 / 3}}},
          // The paper prints the two indices of each entry off the diagonal in the wrong order.
          {"imdrk-5-4",
           {},
           fourth_order_entries({0.660949255604937, 0.060653001401867, 0.242201390400848, 0.221847558352979,
                                 0.020022818960029, 1.137542996287740, 0.102668776898047, 0.191388711018110,
                                 0.625266691721946}),
           fourth_order_entries({-0.177750705279127, -0.016311560509453, -0.354733903778084,
                                 -0.324923198367868, -0.029325895786881, -0.403963513682271,
                                 -0.036459667895230, -0.161628266349058, -0.218859021269943})},
          {"md-imex-3-2",
           {{2, 1, 1.0}, {3, 1, 0.5}, {3, 2, 0.5}},
           {{1, 1, 0.5}, {2, 1, 0.5}, {3, 1, 0.5}, {3, 3, 0.5}},
           {{2, 2, -0.5}, {3, 2, -0.25}}},
          {"md-imex-6-3",
           {{2, 1, 0.064631725156397},
            {3, 1, 0.860287477078593},
            {4, 1, 0.259664005325885},
            {4, 3, 0.323441264334256},
            {5, 1, 0.273935075266107},
            {5, 3, 0.090903225623586},
            {5, 4, 0.310757966128278},
            {6, 1, 0.225810414773773},
            {6, 3, 0.175213169672431},
            {6, 4, 0.598976415553796}},
           {{2, 2, 2.0},
            {3, 2, 0.471466963417009},
            {3, 3, 0.388820513661584},
            {4, 2, 0.385837646486197},
            {4, 3, 0.113738158737554},
            {4, 4, 0.083529464436389},
            {5, 2, 0.380686852681912},
            {5, 3, 0.031966130008218},
            {5, 4, 0.023475971031425},
            {5, 5, 1.793313488277995},
            {6, 2, 0.299183707820065},
            {6, 3, 0.061613731773316},
            {6, 4, 0.045249211646092},
            {6, 5, 0.593953348760527}},
           {{1, 1, -0.871358934880525},
            {2, 1, -0.271731819181020},
            {2, 2, -0.856842702601821},
            {3, 1, -0.730006747169852},
            {3, 2, -0.201986513560852},
            {4, 1, -0.247226665569066},
            {4, 2, -0.165301085890380},
            {5, 1, -0.614323072678900},
            {5, 2, -0.163094375848475},
            {5, 5, -2.0},
            {6, 1, -0.506222742811925},
            {6, 2, -0.128176688391489},
            {6, 5, -0.662408834420649},
            {6, 6, -0.205134529930013}}}};
}

double largest_difference(const matrix<double>& m, const std::vector<printed_entry>& printed) {
  double largest = 0.0;
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.cols(); ++j) {
      const auto found = std::find_if(printed.begin(), printed.end(), [&](const printed_entry& entry) {
        return entry.row == i + 1 && entry.column == j + 1;
      });
      largest = maximum(largest, std::abs(m(i, j) - (found == printed.end() ? 0.0 : found->value)));
    }
  return largest;
}

}  // namespace

std::vector<printed_condition> printed_implicit_conditions(const butcher_form<double>& tableau) {
  const abscissae t(tableau);
  const auto& [Ah, A, Ad, e, c, ch, cd, b, bh, bd] = t;
  return {
      {"G", inner(b, e), 1.0},
      {"G[G]", inner(b, c) + inner(bd, e), 1.0 / 2},
      {"G[G,G]", inner(b, c * c) + 2 * inner(bd, c), 1.0 / 3},
      {"G[G[G]]", inner(b, A * c) + inner(b, cd) + inner(bd, c), 1.0 / 6},
      {"G[G,G,G]", inner(b, c * c * c) + 3 * inner(bd, c * c), 1.0 / 4},
      {"G[G,G[G]]",
       inner(b, c * (A * c)) + inner(b, c * cd) + inner(bd, c * c) + inner(bd, A * c) + inner(bd, cd),
       1.0 / 8},
      {"G[G[G,G]]", inner(b, A * (c * c)) + 2 * inner(b, Ad * c) + inner(bd, c * c), 1.0 / 12},
      {"G[G[G[G]]]",
       inner(b, A * (A * c)) + inner(b, A * cd) + inner(b, Ad * c) + inner(bd, A * c) + inner(bd, cd),
       1.0 / 24},
  };
}

std::vector<printed_condition> printed_imex_conditions(const butcher_form<double>& tableau) {
  const abscissae t(tableau);
  const auto& [Ah, A, Ad, e, c, ch, cd, b, bh, bd] = t;
  return {
      {"G", inner(b, e), 1.0},
      {"F", inner(bh, e), 1.0},
      {"G[G]", inner(b, c) + inner(bd, e), 1.0 / 2},
      {"G[F]", inner(b, ch), 1.0 / 2},
      {"F[G]", inner(bh, c), 1.0 / 2},
      {"F[F]", inner(bh, ch), 1.0 / 2},
      {"G[G[G]]", inner(b, A * c) + inner(bd, c) + inner(b, cd), 1.0 / 6},
      {"G[G[F]]", inner(b, A * ch) + inner(bd, ch), 1.0 / 6},
      {"G[F[G]]", inner(b, Ah * c), 1.0 / 6},
      {"G[F[F]]", inner(b, Ah * ch), 1.0 / 6},
      {"F[G[G]]", inner(bh, A * c) + inner(bh, cd), 1.0 / 6},
      {"F[G[F]]", inner(bh, A * ch), 1.0 / 6},
      {"F[F[G]]", inner(bh, Ah * c), 1.0 / 6},
      {"F[F[F]]", inner(bh, Ah * ch), 1.0 / 6},
      {"G[G,G]", inner(b, c * c) + 2 * inner(bd, c), 1.0 / 3},
      {"G[F,G]", inner(b, c * ch) + inner(bd, ch), 1.0 / 3},
      {"G[F,F]", inner(b, ch * ch), 1.0 / 3},
      {"F[G,G]", inner(bh, c * c), 1.0 / 3},
      {"F[F,G]", inner(bh, c * ch), 1.0 / 3},
      {"F[F,F]", inner(bh, ch * ch), 1.0 / 3},
  };
}

const printed_tableau& printed_butcher_form(const std::string& method) {
  static const std::vector<printed_tableau> all = make_tableaux();
  for (const auto& one : all)
    if (one.method == method) return one;
  throw input_error("the paper prints no Butcher form of '" + method + "'");
}

double distance_to_print(const std::string& method) {
  const auto& printed = printed_butcher_form(method);
  const auto form = to_butcher(find_method(method).coefficients<double>());
  return maximum({largest_difference(form.A_hat, printed.A_hat), largest_difference(form.A, printed.A),
                  largest_difference(form.A_dot, printed.A_dot)});
}

butcher_form<double> random_tableau(std::size_t stages, std::uint64_t seed) {
  std::uint64_t state = seed * 2654435761U + 88172645463325252U;  // xorshift: the standard does not fix how
  const auto draw = [&state] {                                    // its engines are mapped to numbers
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return static_cast<double>(state >> 11) / 4503599627370496.0 - 1.0;
  };
  butcher_form<double> b{matrix<double>(stages, stages), matrix<double>(stages, stages),
                         matrix<double>(stages, stages)};
  for (std::size_t i = 0; i < stages; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      b.A(i, j) = draw();
      b.A_dot(i, j) = draw();
      if (j < i) b.A_hat(i, j) = draw();
    }
  return b;
}

}  // namespace apsis::paper
