#include <apsis/semidiscrete/cell_unknown.hpp>

#include <apsis/scheme/quartic.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include <boost/math/quadrature/gauss.hpp>

namespace apsis {
namespace {

struct interval {
  double centre, half;
};

/// Returns the parts between the jumps in a cell, or the cell itself if there are no jumps. A jump at an
/// edge, up to rounding, does not count.
std::vector<interval> smooth_parts(const std::vector<double>& jumps, double centre, double half) {
  std::vector<double> ends = {centre - half};
  for (auto jump = std::lower_bound(jumps.begin(), jumps.end(), centre - half);
       jump != jumps.end() && *jump < centre + half; ++jump)
    if (std::abs(*jump - centre) < (1.0 - 1e-9) * half) ends.push_back(*jump);
  if (ends.size() == 1) return {{centre, half}};
  ends.push_back(centre + half);
  std::vector<interval> parts;
  for (std::size_t k = 1; k < ends.size(); ++k)
    parts.push_back({0.5 * (ends[k - 1] + ends[k]), 0.5 * (ends[k] - ends[k - 1])});
  return parts;
}

class averages_of_cells final : public cell_unknown {
 public:
  std::string plural() const override { return "cell averages"; }
  double second_moment() const override { return 1.0 / 12.0; }
  std::span<const weighted_point> points() const override {
    static constexpr weighted_point gauss[] = {{gauss3::xi[0], gauss3::weight[0]},
                                               {gauss3::xi[1], gauss3::weight[1]},
                                               {gauss3::xi[2], gauss3::weight[2]}};
    static_assert(std::size(gauss) == gauss3::points);
    return gauss;
  }

  void sample(const state_function& u, const std::vector<double>& jumps, const position& centre, double width,
              std::span<double> values, double* row) const override {
    const double half = 0.5 * width;
    const auto add = [&](double x, double weight) {
      u({x, centre[1], centre[2]}, values);
      for (std::size_t k = 0; k < values.size(); ++k) row[k] += weight * values[k];
    };
    // Ten points on every smooth part are exact to rounding for data that the mesh resolves.
    using rule = boost::math::quadrature::gauss<double, 10>;
    for (const auto& part : smooth_parts(jumps, centre[0], half)) {
      for (std::size_t q = 0; q < rule::abscissa().size(); ++q) {
        const double weight = part.half / half * 0.5 * rule::weights()[q];
        add(part.centre - part.half * rule::abscissa()[q], weight);
        add(part.centre + part.half * rule::abscissa()[q], weight);
      }
    }
  }

  std::string why_not_restricted(int finer, int cells) const override {
    const std::string why = cell_unknown::why_not_restricted(finer, cells);
    return why.empty() && finer % cells != 0 ? "averages need whole cells" : why;
  }

  std::vector<double> restricted(const std::vector<double>& finer, int width, int cells,
                                 bool) const override {
    const auto components = static_cast<std::size_t>(width);
    const std::size_t ratio = finer.size() / components / static_cast<std::size_t>(cells);
    std::vector<double> coarse(finer.size() / ratio, 0.0);
    for (std::size_t k = 0; k < finer.size(); ++k)
      coarse[k / components / ratio * components + k % components] += finer[k];
    for (double& value : coarse) value /= static_cast<double>(ratio);
    return coarse;
  }
};

/// Polynomial interpolation between the centres of a uniform mesh.
class interpolation {
 public:
  interpolation(long fine, long coarse, bool periodic) : fine_(fine), coarse_(coarse), periodic_(periodic) {}

  std::vector<double> operator()(const std::vector<double>& values, std::size_t components) const {
    std::vector<double> out(static_cast<std::size_t>(coarse_) * components, 0.0);
    for (long i = 0; i < coarse_; ++i) {
      // Position of the centre in cells of the fine mesh, (i + ½) fine/coarse − ½, over a common denominator.
      const long above = (2 * i + 1) * fine_ - coarse_, below = 2 * coarse_;
      double* row = out.data() + static_cast<std::size_t>(i) * components;
      const long first = first_point(above / below), count = std::min(longest, fine_);
      for (long k = 0; k < count; ++k) {
        const double weight =
            lagrange(static_cast<double>(above - first * below) / static_cast<double>(below), k, count);
        const auto from = static_cast<std::size_t>(((first + k) % fine_ + fine_) % fine_) * components;
        for (std::size_t c = 0; c < components && weight != 0.0; ++c) row[c] += weight * values[from + c];
      }
    }
    return out;
  }

 private:
  static constexpr long longest = 8;

  /// Returns the first point of the stencil around a position. Stencils stay inside a mesh that is
  /// not continued periodically.
  long first_point(long position) const {
    const long first = position - (longest / 2 - 1);
    return periodic_ && fine_ >= longest ? first : std::clamp(first, 0L, std::max(0L, fine_ - longest));
  }

  /// Returns the Lagrange polynomial that is 1 at point k of 0 … count−1 and 0 at the others.
  static double lagrange(double s, long k, long count) {
    double product = 1.0;
    for (long m = 0; m < count; ++m)
      if (m != k) product *= (s - static_cast<double>(m)) / static_cast<double>(k - m);
    return product;
  }

  long fine_, coarse_;
  bool periodic_;
};

class values_at_centres final : public cell_unknown {
 public:
  std::string plural() const override { return "point values"; }
  double second_moment() const override { return 0.0; }
  std::span<const weighted_point> points() const override {
    static constexpr weighted_point centre[] = {{0.0, 1.0}};
    return centre;
  }

  void sample(const state_function& u, const std::vector<double>&, const position& centre, double,
              std::span<double> values, double* row) const override {
    u(centre, values);
    for (std::size_t k = 0; k < values.size(); ++k) row[k] += values[k];
  }

  std::vector<double> restricted(const std::vector<double>& finer, int components, int cells,
                                 bool periodic) const override {
    const auto fine = static_cast<long>(finer.size() / static_cast<std::size_t>(components));
    return interpolation(fine, cells, periodic)(finer, static_cast<std::size_t>(components));
  }
};

}  // namespace

std::string cell_unknown::why_not_restricted(int finer, int cells) const {
  return finer < cells ? "it is coarser" : "";
}

const cell_unknown& cell_averages() {
  static const averages_of_cells averages;
  return averages;
}

const cell_unknown& point_values() {
  static const values_at_centres values;
  return values;
}

}  // namespace apsis
