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
  std::string label;                                  ///< "" does not appear in the legend
  std::vector<double> x,                              ///< abscissae of the points
      y;                                              ///< ordinates, as many
  curve_style style = curve_style::line_and_markers;  ///< of line and markers
  int colour = -1;                                    ///< index into the palette; −1: the next one, −2: black
};

/// A map: value[row][column] at (x[column], y[row]), drawn with numbers in the fields where there is room.
struct heat_map {
  std::vector<double> x,                   ///< centres of the columns
      y;                                   ///< centres of the rows
  std::vector<std::vector<double>> value;  ///< [row][column]; not drawn where it is not finite
  std::string label;                       ///< of the colour bar
  double lowest = 0.0,                     ///< lower end of the colour bar
      highest = 1.0;                       ///< upper end
};

/// A pair of axes with curves, or with one map.
struct panel {
  std::string title,                ///< above the axes
      x_label,                      ///< with its unit or "dimensionless"
      y_label;                      ///< with its unit or "dimensionless"
  bool log_x = false,               ///< whether x is logarithmic
      log_y = false;                ///< whether y is logarithmic
  std::vector<curve> curves;        ///< in the order of the legend
  std::vector<heat_map> maps;       ///< none or one
  std::vector<double> slopes = {};  ///< orders to draw as triangles (log–log panels)
};

/// Panels under one title.
struct picture {
  std::string name;           ///< of the file, without ending
  std::string title;          ///< above all panels
  std::string caption;        ///< what to see
  std::vector<panel> panels;  ///< drawn row by row
};

/// As python/apsis/plot reads it; numbers that are not finite become null.
nlohmann::ordered_json to_json(const picture& p);

}  // namespace apsis
