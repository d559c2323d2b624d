#include <apsis/semidiscrete/cell_unknown.hpp>

#include <apsis/core/index.hpp>
#include <apsis/scheme/quartic.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

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

/// Values on a mesh that is partly restricted.
class partly_restricted {
 public:
  partly_restricted(std::vector<double> values, int components, const grid& mesh)
      : values_(std::move(values)), components_(at(components)) {
    for (int k = 0; k < 3; ++k) cells_[at(k)] = mesh.cells(k);
    for (int cell = 0; cell < mesh.size(); ++cell) is_gas_.push_back(mesh.solid(cell) < 0 ? 1 : 0);
  }

  void restrict_along(std::size_t direction, int cells, const cell_unknown& unknown, bool periodic) {
    if (cells == cells_[direction]) return;
    partly_restricted coarse = *this;
    coarse.cells_[direction] = cells;
    const std::size_t size = at(coarse.cells_[0]) * at(coarse.cells_[1]) * at(coarse.cells_[2]);
    coarse.values_.assign(size * components_, 0.0);
    coarse.is_gas_.assign(size, 0);
    const std::size_t stride = stride_of(direction), count = at(cells_[direction]);
    for (std::size_t outer = 0; outer < is_gas_.size() / (stride * count); ++outer)
      for (std::size_t inner = 0; inner < stride; ++inner) {
        const pencil from{outer * stride * count + inner, stride, count},
            to{outer * stride * at(cells) + inner, stride, at(cells)};
        for (const run& part : runs_of(from, periodic))
          restrict_run(part, from, unknown, periodic, to, coarse);
      }
    *this = std::move(coarse);
  }

  std::vector<double> values() && { return std::move(values_); }

 private:
  /// Cells first, first + stride, … of a line.
  struct pencil {
    std::size_t first, stride, cells;
    /// Returns the number of a cell. It is counted periodically.
    std::size_t operator[](std::size_t i) const { return first + i % cells * stride; }
  };
  /// Neighbouring cells of gas of a pencil. Those across a periodic face have numbers above that of the last.
  struct run {
    std::size_t begin, end;
  };

  std::size_t stride_of(std::size_t direction) const {
    std::size_t stride = 1;
    for (std::size_t k = 2; k > direction; --k) stride *= at(cells_[k]);
    return stride;
  }

  std::vector<run> runs_of(const pencil& line, bool periodic) const {
    std::size_t start = 0;  // a cell after a solid one, if gas crosses the periodic face
    while (periodic && start < line.cells && is_gas_[line[start + line.cells - 1]] != 0) ++start;
    if (start == line.cells) return {{0, line.cells}};
    std::vector<run> runs;
    bool inside = false;
    for (std::size_t i = start; i < start + line.cells; ++i) {
      const bool gas = is_gas_[line[i]] != 0;
      if (gas && !inside) runs.push_back({i, i});
      if (gas) ++runs.back().end;
      inside = gas;
    }
    return runs;
  }

  void restrict_run(const run& part, const pencil& from, const cell_unknown& unknown, bool periodic,
                    const pencil& to, partly_restricted& coarse) const {
    std::vector<double> line;
    line.reserve((part.end - part.begin) * components_);
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const double* row = values_.data() + from[i] * components_;
      line.insert(line.end(), row, row + components_);
    }
    // Boxes end at edges of both meshes, so that these divisions have no remainder.
    const std::size_t begin = part.begin * to.cells / from.cells, end = part.end * to.cells / from.cells;
    const bool whole = part.end - part.begin == from.cells;
    line = unknown.restricted(line, static_cast<int>(components_), static_cast<int>(end - begin),
                              periodic && whole);
    for (std::size_t i = begin; i < end; ++i) {
      const auto row = line.begin() + static_cast<std::ptrdiff_t>((i - begin) * components_);
      std::copy_n(row, components_, coarse.values_.data() + to[i] * components_);
      coarse.is_gas_[to[i]] = 1;
    }
  }

  std::vector<double> values_;
  std::size_t components_;
  std::array<int, 3> cells_ = {1, 1, 1};
  std::vector<char> is_gas_;
};

}  // namespace

std::string cell_unknown::why_not_restricted(int finer, int cells) const {
  return finer < cells ? "it is coarser" : "";
}

std::vector<double> cell_unknown::restricted_to_mesh(std::vector<double> finer, int components,
                                                     const grid& fine, const grid& coarse,
                                                     const std::array<bool, 3>& periodic) const {
  partly_restricted state(std::move(finer), components, fine);
  for (int k = 0; k < fine.dimensions(); ++k)
    state.restrict_along(at(k), coarse.cells(k), *this, periodic[at(k)]);
  return std::move(state).values();
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
