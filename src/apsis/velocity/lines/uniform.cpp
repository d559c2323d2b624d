#include <apsis/velocity/velocity_line_registry.hpp>

namespace apsis {

extern const velocity_line_entry velocity_line_uniform;
const velocity_line_entry velocity_line_uniform = {
    .name = "uniform",
    .description = "midpoints of equal intervals of [-max, max]: spectrally accurate for smooth f",
    .source = "midpoint rule",
    .make = [](int points, double max) { return velocity_line(points, max); }};

}  // namespace apsis
