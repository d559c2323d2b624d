#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

/// Draws cases of a gas in a plane or in space. Every face and every solid box has a boundary of a
/// random kind, with values that are formulas of the position and of time. Boxes touch faces, corners
/// and each other. Parts of the space are nearly empty. No expression draws twice, so all compilers draw
/// the same cases.
class random_boxes {
 public:
  explicit random_boxes(unsigned seed) : random_(seed) {}

  /// Returns a case of 2 or 3 dimensions with the longest step that promises positivity.
  std::string next(const std::string& model, const std::string& method, int dimensions) {
    d_ = dimensions;
    degrees_ = model == "bgk" ? d_ + below(4) : std::max(d_, 3);
    for (auto& n : cells_) n = d_ == 2 ? 6 + below(14) : 5 + below(3);
    for (auto& length : length_) length = number(0.5, 2.0);
    std::string text = fmt::format("[model]\nname = \"{}\"\ndegrees_of_freedom = {}\n", model, degrees_);
    if (model != "bgk") text += "tails = \"nonnegative\"\n";
    text += "epsilon = " + epsilon();
    text += fmt::format("\ncollision_rate = \"viscosity\"\nviscosity_exponent = {:.2f}\n", number(0.5, 1.0));
    text += initial() + space();
    text += "[velocity]\nmax = 8\nset = \"" + (d_ == 2 ? pick({"uniform", "graded"}) : "uniform");
    text += fmt::format("\"\npoints = {}\n", d_ == 2 ? 20 : 12);
    return text + fmt::format("[time]\nmethod = \"{}\"\nsafety = 1\nend = 1e9\n", method);
  }

 private:
  static constexpr std::array<const char*, 6> face_names = {"left", "right", "bottom",
                                                            "top",  "back",  "front"};

  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  std::string text_of(double from, double to) { return fmt::format("{:.3f}", number(from, to)); }
  std::string power(double from, double to) {
    return fmt::format("{:.3g}", std::pow(10.0, number(from, to)));
  }
  std::string pick(const std::vector<std::string>& from) {
    return from[static_cast<std::size_t>(below(static_cast<int>(from.size())))];
  }

  /// Returns ε from 0 to 1e12, uniform or not.
  std::string epsilon() {
    if (below(6) == 0) return "0";
    if (below(4) == 0) return "\"10^(" + text_of(-10.0, 5.0) + " + 5*sin(3*x + 2*y))\"";
    return power(-16.0, 12.0);
  }
  /// Returns a wave in space and time between −1 and 1.
  std::string wave() {
    std::string phase = text_of(-200.0, 200.0) + "*t";
    for (int k = 0; k < d_; ++k) phase += fmt::format(" + {:.2f}*{}", number(-9.0, 9.0), "xyz"[k]);
    return "sin(" + phase + ")";
  }
  /// Returns a positive formula around a number.
  std::string around(const std::string& middle, double amplitude) {
    std::string text = "\"" + middle + "*(1 + ";
    text += text_of(0.0, amplitude) + "*";
    return text + wave() + ")\"";
  }
  /// Returns a temperature that the velocities resolve. They are coarse in space.
  std::string temperature() {
    return d_ == 2 ? around(text_of(0.9, 1.3), 0.3) : around(text_of(1.2, 1.7), 0.2);
  }
  /// Returns a vector of waves whose component across an axis is 0.
  std::string waves(int across) {
    std::string all;
    for (int k = 0; k < d_; ++k) {
      all += k == across ? "0*" : text_of(-1.0, 1.0) + "*";
      all += wave() + (k + 1 < d_ ? "\", \"" : "");
    }
    return "[\"" + all + "\"]";
  }

  /// Returns a moving gas with a temperature from 0.7 to 1.4.
  std::string state(const std::string& rho) {
    std::string text = "rho = " + rho + "\nT = " + text_of(0.7, 1.4) + "\nu = [";
    for (int k = 0; k < d_; ++k) text += text_of(-0.8, 0.8) + ", ";
    return text + "]\n";
  }
  /// Returns initial data with two half spaces, the second on top of the first. They have other states, most
  /// of them nearly empty.
  std::string initial() {
    std::string text = "[initial]\n" + state("1");
    for (int half = 0; half < 2; ++half) {
      text += "[[initial.region]]\nwhere = \"" + text_of(-0.1, 0.1) + " < ";
      for (std::size_t k = 0; k < static_cast<std::size_t>(d_); ++k)
        text += fmt::format("{:+.2f}*({}/{:.3f} - 0.5)", k == 0 ? 2 * below(2) - 1 : number(-1.0, 1.0),
                            "xyz"[k], length_[k]);
      text += "\"\n";
      text += state(power(-14.0, 0.5));
    }
    return text;
  }

  std::string space() {
    std::string domain;
    for (std::size_t k = 0; k < static_cast<std::size_t>(d_); ++k)
      domain += fmt::format("[0, {:.17g}], ", length_[k]);
    std::string text =
        fmt::format("[space]\ncells = [{}]\ndomain = [{}]\nlimiter = \"positivity\"\nreconstruction = \"",
                    fmt::join(cells_.begin(), cells_.begin() + d_, ", "), domain);
    text += pick({"weno5-z", "weno5-z", "weno5-js", "upwind1", "upwind5"}) + "\"\n";
    for (int boxes = below(4); boxes > 0; --boxes) text += box();
    for (int k = 0; k < d_; ++k) {
      if (below(4) == 0) continue;  // periodic, the default
      for (int side = 2 * k; side < 2 * k + 2; ++side) {
        text += fmt::format("[boundary.{}]\n", face_names[static_cast<std::size_t>(side)]);
        text += wall(k, true);
      }
    }
    return text;
  }

  /// Returns a box, often at a face, of at most half of the cells along each axis. Three boxes thus leave
  /// some cells.
  std::string box() {
    std::string from, to;
    for (std::size_t k = 0; k < static_cast<std::size_t>(d_); ++k) {
      const int n = cells_[k], size = 1 + below(n / 2), place = below(3);
      const int first = place == 0 ? 0 : place == 1 ? n - size : below(n - size + 1);
      from += fmt::format("{:.17g}, ", length_[k] * first / n);
      to += fmt::format("{:.17g}, ", length_[k] * (first + size) / n);
    }
    return fmt::format("[[space.solid]]\nfrom = [{}]\nto = [{}]\n", from, to) + wall(-1, false);
  }

  /// Returns a boundary of a random kind across an axis, or around a box, which does not move.
  std::string wall(int axis, bool moves) {
    const std::string kind = pick(
        {"diffuse", "diffuse", "diffuse", "inflow", "symmetry", "outflow", "far-field", "pressure", "given"});
    std::string text = fmt::format("kind = \"{}\"\n", kind);
    if (kind == "diffuse") {
      if (below(3) > 0) text += "accommodation = " + around(text_of(0.0, 0.5), 0.9) + "\n";
      if (moves) text += "velocity = " + waves(axis) + "\n";
    } else if (kind == "pressure") {
      text += "p = " + around(text_of(0.1, 2.0), 0.9) + "\n";
    } else if (kind == "given") {
      const std::string f = around(text_of(0.0, 2.0), 1.0), shape = "*exp(-abs(v_x)^3 - v_y^2)\"\n";
      const std::string formula = f.substr(0, f.size() - 1) + shape;
      text += d_ < degrees_ ? "g = " + formula + "h = " + formula : "f = " + formula;
    } else if (kind == "inflow" || kind == "far-field") {
      text += "rho = " + around(power(-14.0, 1.0), 0.9) + "\n";
      text += "u = " + waves(-1) + "\n";
    }
    if (kind == "diffuse" || kind == "pressure" || kind == "inflow" || kind == "far-field")
      text += "T = " + temperature() + "\n";
    return text;
  }

  std::mt19937 random_;
  int d_ = 2, degrees_ = 2;
  std::array<int, 3> cells_{};
  std::array<double, 3> length_{};
};
