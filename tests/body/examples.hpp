#pragma once

#include <apsis/body/shape_registry.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

/// Shapes with an independent description of their interior.
namespace body_examples {

using apsis::position;

/// A shape with values of its keys.
struct example {
  std::string name;            ///< name of the kind
  int dimensions = 2;          ///< 2 or 3
  apsis::shape_values values;  ///< values of its keys
  std::function<bool(const position& x)>
      is_body;              ///< returns true in the body, by another formula than that of the shape
  bool is_distance = true;  ///< true if φ is a distance, with Lipschitz constant 1
};

using numbers = std::vector<double>;
using points = std::vector<std::vector<double>>;

inline std::shared_ptr<const apsis::shape> made(const std::string& name, const apsis::shape_values& values,
                                                int dimensions) {
  return apsis::make_shape(name, values, dimensions);
}

inline apsis::shape_list circles() {
  return {made("circle", {{"centre", numbers{0.3, 0.0}}, {"radius", 0.6}}, 2),
          made("circle", {{"centre", numbers{-0.4, 0.1}}, {"radius", 0.5}}, 2)};
}

inline double square(double a) {
  return a * a;
}
inline bool in_circle(const position& x, double a, double b, double r) {
  return square(x[0] - a) + square(x[1] - b) <= r * r;
}

inline std::vector<example> planar_examples() {
  const double c = std::cos(0.5), s = std::sin(0.5);
  const auto in_first = [](const position& x) { return in_circle(x, 0.3, 0.0, 0.6); };
  const auto in_second = [](const position& x) { return in_circle(x, -0.4, 0.1, 0.5); };
  return {
      {"circle",
       2,
       {{"centre", numbers{0.1, -0.2}}, {"radius", 0.7}},
       [](const position& x) { return in_circle(x, 0.1, -0.2, 0.7); }},
      {"ellipse",
       2,
       {{"centre", numbers{0.2, 0.1}},
        {"semi_axes", numbers{0.9, 0.3}},
        {"angle", 0.5 * 180.0 / std::numbers::pi}},
       [c, s](const position& x) {
         const double u = x[0] - 0.2, v = x[1] - 0.1;
         return square((c * u + s * v) / 0.9) + square((c * v - s * u) / 0.3) <= 1.0;
       },
       false},
      {"box",
       2,
       {{"from", numbers{-0.5, -0.2}}, {"to", numbers{0.7, 0.6}}},
       [](const position& x) { return x[0] >= -0.5 && x[0] <= 0.7 && x[1] >= -0.2 && x[1] <= 0.6; }},
      // An L with clockwise corners.
      {"polygon",
       2,
       {{"points", points{{0, 0}, {0, 1}, {0.4, 1}, {0.4, 0.5}, {1, 0.5}, {1, 0}}}},
       [](const position& x) {
         return x[0] >= 0.0 && x[1] >= 0.0 && ((x[0] <= 0.4 && x[1] <= 1.0) || (x[0] <= 1.0 && x[1] <= 0.5));
       }},
      {"half_space",
       2,
       {{"point", numbers{0.2, 0.3}}, {"normal", numbers{1.0, 2.0}}},
       [](const position& x) { return x[0] + 2.0 * x[1] <= 0.8; }},
      {"formula",
       2,
       {{"phi", [](const position& x) { return std::hypot(x[0], x[1]) - 0.5; }}},
       [](const position& x) { return in_circle(x, 0.0, 0.0, 0.5); }},
      {"union", 2, {{"shapes", circles()}}, [=](const position& x) { return in_first(x) || in_second(x); }},
      {"intersection",
       2,
       {{"shapes", circles()}},
       [=](const position& x) { return in_first(x) && in_second(x); }},
      {"difference",
       2,
       {{"shapes", circles()}},
       [=](const position& x) { return in_first(x) && !in_second(x); }},
      {"hollow", 2, {{"of", apsis::shape_list{circles().front()}}}, [=](const position& x) {
         return !in_first(x);
       }}};
}

inline std::vector<example> spatial_examples() {
  const auto planar = [](double a, double b, double r) {
    return apsis::shape_list{made("circle", {{"centre", numbers{a, b}}, {"radius", r}}, 2)};
  };
  return {{"sphere",
           3,
           {{"centre", numbers{0.1, -0.2, 0.3}}, {"radius", 0.8}},
           [](const position& x) {
             return square(x[0] - 0.1) + square(x[1] + 0.2) + square(x[2] - 0.3) <= 0.64;
           }},
          {"ellipsoid",
           3,
           {{"centre", numbers{0.1, 0.0, 0.2}}, {"semi_axes", numbers{0.9, 0.3, 0.5}}},
           [](const position& x) {
             return square((x[0] - 0.1) / 0.9) + square(x[1] / 0.3) + square((x[2] - 0.2) / 0.5) <= 1.0;
           },
           false},
          // The axis is (1, 2, 2)/3, the ends lie at ±0.6.
          {"cylinder",
           3,
           {{"centre", numbers{0.1, 0.0, 0.0}},
            {"axis", numbers{0.5, 1.0, 1.0}},
            {"radius", 0.5},
            {"length", 1.2}},
           [](const position& x) {
             const double u = x[0] - 0.1, along = (u + 2.0 * x[1] + 2.0 * x[2]) / 3.0;
             return std::abs(along) <= 0.6 && square(u) + square(x[1]) + square(x[2]) - square(along) <= 0.25;
           }},
          {"cylinder",
           3,
           {{"centre", numbers{0.1, 0.2, 0.0}}, {"axis", numbers{0.0, 0.0, -3.0}}, {"radius", 0.5}},
           [](const position& x) { return in_circle(x, 0.1, 0.2, 0.5); }},
          {"box",
           3,
           {{"from", numbers{-0.5, -0.2, -0.3}}, {"to", numbers{0.7, 0.6, 0.1}}},
           [](const position& x) {
             return x[0] >= -0.5 && x[0] <= 0.7 && x[1] >= -0.2 && x[1] <= 0.6 && x[2] >= -0.3 && x[2] <= 0.1;
           }},
          {"half_space",
           3,
           {{"point", numbers{0.2, 0.3, 0.0}}, {"normal", numbers{1.0, 2.0, -2.0}}},
           [](const position& x) { return x[0] + 2.0 * x[1] - 2.0 * x[2] <= 0.8; }},
          {"extruded",
           3,
           {{"of", planar(0.2, 0.1, 0.6)}, {"from", -0.4}, {"to", 0.5}},
           [](const position& x) { return in_circle(x, 0.2, 0.1, 0.6) && x[2] >= -0.4 && x[2] <= 0.5; }},
          {"extruded",
           3,
           {{"of", planar(0.2, 0.1, 0.6)}, {"to", 0.5}},
           [](const position& x) { return in_circle(x, 0.2, 0.1, 0.6) && x[2] <= 0.5; }},
          // A torus.
          {"turned", 3, {{"of", planar(0.1, 0.7, 0.3)}}, [](const position& x) {
             return square(x[0] - 0.1) + square(std::sqrt(square(x[1]) + square(x[2])) - 0.7) <= 0.09;
           }}};
}

inline std::vector<example> all_examples() {
  auto all = planar_examples();
  for (auto& one : spatial_examples()) all.push_back(std::move(one));
  return all;
}

/// Draws random points of [−1.5, 1.5]^d, the same in every run.
class random_points {
 public:
  explicit random_points(int dimensions) : dimensions_(static_cast<std::size_t>(dimensions)) {}
  position next() {
    position x = {};
    for (std::size_t k = 0; k < dimensions_; ++k) x[k] = uniform_(engine_);
    return x;
  }

 private:
  std::size_t dimensions_;
  std::mt19937_64 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1.5, 1.5};
};

}  // namespace body_examples
