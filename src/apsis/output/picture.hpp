#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Pictures as data: what is to be seen, not how it is drawn (python/apsis/plot draws them, all in one
/// style). Numbers that are not finite, and numbers ≤ 0 on a logarithmic axis, are left out of a curve.
enum class curve_style { line, dashed, dash_dot, markers, line_and_markers, dashed_and_markers };

/// One curve. Curves of the same `colour` (≥ 0) share it; −1 takes the next one, −2 is black (references).
struct curve {
  std::string label;  ///< "" does not appear in the legend
  std::vector<double> x, y;
  curve_style style = curve_style::line_and_markers;
  int colour = -1;
};

/// A map: value[row][column] at (x[column], y[row]), drawn with numbers in the fields where there is room.
struct heat_map {
  std::vector<double> x, y;
  std::vector<std::vector<double>> value;
  std::string label;  ///< of the colour bar
  double lowest = 0.0, highest = 1.0;
};

/// A pair of axes with curves, or with one map.
struct panel {
  std::string title, x_label, y_label;  ///< labels carry units or "dimensionless"
  bool log_x = false, log_y = false;
  std::vector<curve> curves;
  std::vector<heat_map> maps;       ///< none or one
  std::vector<double> slopes = {};  ///< orders to draw as triangles (log–log panels)
};

struct picture {
  std::string name;  ///< of the file, without ending
  std::string title;
  std::string caption;  ///< what to see
  std::vector<panel> panels;
};

nlohmann::ordered_json to_json(const picture& p);

}  // namespace apsis
