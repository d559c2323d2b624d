#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Line style of a curve. Pictures are data; python/apsis/plot draws them in one style. Values that are not
/// finite, or not positive on a logarithmic axis, are omitted from a curve.
enum class curve_style { line, dashed, dash_dot, markers, line_and_markers, dashed_and_markers };

/// One curve of a panel.
struct curve {
  std::string label;                                  ///< legend entry; "" for none
  std::vector<double> x,                              ///< abscissae of the points
      y;                                              ///< ordinates, as many as abscissae
  curve_style style = curve_style::line_and_markers;  ///< line and markers
  int colour = -1;  ///< palette index, which curves may share; −1: next, −2: black
};

/// A map of value[row][column] at (x[column], y[row]), with numbers printed in the cells where they fit.
struct heat_map {
  std::vector<double> x,                   ///< centres of the columns
      y;                                   ///< centres of the rows
  std::vector<std::vector<double>> value;  ///< [row][column]; entries that are not finite are not drawn
  std::string label;                       ///< label of the colour bar
  double lowest = 0.0,                     ///< lower end of the colour bar
      highest = 1.0;                       ///< upper end
};

/// A pair of axes with curves or one map.
struct panel {
  std::string title,                ///< title above the axes
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
  std::string name;           ///< file name without extension
  std::string title;          ///< title above all panels
  std::string caption;        ///< what the picture shows
  std::vector<panel> panels;  ///< drawn row by row
};

/// Returns the picture as python/apsis/plot reads it; numbers that are not finite become null.
nlohmann::ordered_json to_json(const picture& p);

}  // namespace apsis
