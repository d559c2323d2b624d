#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/config/case_parts.hpp>
#include <apsis/config/choices.hpp>
#include <apsis/config/epsilon_formula.hpp>
#include <apsis/config/initial_table.hpp>
#include <apsis/config/reference_values.hpp>
#include <apsis/config/surface_tables.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/graded_start.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/gas_scales.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/output/probe.hpp>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace apsis {

/// steady.tolerance of a case with a table [steady] that gives none.
inline constexpr double usual_steady_tolerance = 1e-8;

/// A resolved case: every key has a value, every name exists. The files of config/keys/ document the
/// keys (`apsis show case`).
struct case_config {
  std::string source;                          ///< file or name of the built-in case
  std::map<std::string, source_place> places;  ///< places of keys and tables, for later messages
  std::set<std::string> given;                 ///< paths of the keys that the case or an override sets
  std::string title;                           ///< one line
  formula_constants constants;                 ///< table [parameters]: constants of all formulas
  /// Table [gas], as given: quantities with units as text.
  struct {
    std::optional<std::string> name, mass, viscosity, viscosity_temperature;
    std::optional<double> viscosity_exponent, prandtl;
    std::optional<int> degrees_of_freedom;
    std::optional<std::string> pressure, density, number_density, temperature, length;
  } gas;
  std::optional<gas_scales> scales;        ///< units of dimensionless quantities; with a table [gas]
  std::vector<std::string> unit_warnings;  ///< about numbers that probably lack a unit; with a table [gas]
  /// Table [model].
  struct {
    std::string name;
    epsilon_formula epsilon;  ///< relaxation time ε
    std::string initial;      ///< name of one of the model's initial data; "" with a table [initial]
    std::map<std::string, double> parameters;    ///< numeric parameters of the model; defaults if absent
    std::map<std::string, std::string> options;  ///< string options of the model; defaults if absent
    std::map<std::string, std::vector<std::string>> lists;  ///< lists of the model; defaults if absent
  } model;
  initial_table prescribed;  ///< table [initial]; empty if model.initial names the data
  /// Table [space], of models with space.
  struct {
    std::vector<int> cells = {40};                             ///< in every direction
    std::vector<std::array<double, 2>> domain = {{0.0, 1.0}};  ///< lower and upper end in every direction
    std::string discretization = "finite-volume";              ///< by discretization_key
    std::optional<std::string> collisions;  ///< where cells collide; default: the first choice
    std::string reconstruction = "weno5-z";
    limiter_choice limiter = limiter_choice::none;
    std::string boundary = "periodic";       ///< kind of every face without its own kind
    std::optional<std::vector<int>> blocks;  ///< blocks of cells in every direction, one for each process
    geometry_choice geometry = geometry_choice::cartesian;
  } space;
  /// Returns whether the last coordinate is the distance r from an axis of symmetry.
  bool is_axisymmetric() const { return space.geometry == geometry_choice::axisymmetric; }
  std::array<face_table, 6> faces;  ///< tables [boundary.NAME], by face::index(), of models with space
  std::vector<solid_table> solids;  ///< tables [[space.solid]]
  std::vector<body_table> bodies;   ///< tables [[space.body]]
  /// Table [force], of models with a velocity grid.
  struct {
    std::optional<std::vector<std::string>> acceleration;  ///< formulas in t and the position
  } force;
  /// Table [source], of models with space: variables of the model per unit of time. They are formulas in
  /// t and the position.
  state_formulas source_term;
  /// Table [velocity], of models with a velocity grid.
  struct {
    double max = 0.0;         ///< 0 if the set chooses it
    point_counts points = 0;  ///< 0 if the set chooses it
    equilibrium_choice equilibrium = equilibrium_choice::automatic;
    std::vector<std::string> set = {};      ///< empty: "uniform"
    int rings = 16, angles = 32;            ///< about the axis of axisymmetric flow
    std::optional<double> max_across = {};  ///< largest velocity of the rings; default: max
  } velocity;
  /// Table [time].
  struct {
    std::string method = "auto";  ///< automatic_method until with_chosen_method() replaces it
    std::string method_reason;    ///< why the program chose the method; "" if the case names it
    double end = 0.0;
    std::optional<double> dt, cfl, safety;  ///< exactly one is set
    startup_choice startup = startup_choice::none;
    int startup_growth = default_growth;  ///< ratio of the times of a graded start
    std::optional<double> tolerance;      ///< of the error of a step; dt, cfl or safety also limit the step
    std::string controller{usual_step_law};  ///< step_law of a run with a tolerance
    std::optional<double> steady;            ///< rate of change of the state at which the run ends
  } time;
  /// Table [steady]: the run finds the steady state in place of marching in time. Iterations then count as
  /// time: time.end is `iterations`, and time.dt is 1. The table [time] of the case is not used.
  struct {
    std::optional<double> tolerance;  ///< of residual and change of moments; unset: a run in time
    int iterations = 500;             ///< largest number of iterations
    int images = 3;                   ///< number of images in the mixture
    bool ignores_every = false;       ///< output.every of the case is a time, that is, not a whole number
  } steady_state;
  /// Table [output].
  struct {
    double every = 0.0;                                ///< time between snapshots; 0: only the end
    std::vector<std::string> fields;                   ///< fields of snapshots; empty: the default fields
    units_choice units = units_choice::dimensionless;  ///< of fields, history and report
    distribution_choice distribution = distribution_choice::end;
    std::vector<std::vector<double>> distribution_at;  ///< points whose cells are written; empty: all cells
    int stride = 1;  ///< snapshots of the distribution have every stride-th cell in each direction
    precision_choice precision = precision_choice::double_precision;  ///< of snapshots of the distribution
    int checkpoint_every = 0;                   ///< steps between checkpoints; 0: not by steps
    double checkpoint_minutes = 10.0;           ///< minutes between checkpoints; 0: not by time
    int history_rows = 100000;                  ///< largest number of rows of the history
    std::vector<line_probe> probes;             ///< tables [[output.probe]]
    std::vector<plane_slice> slices;            ///< tables [[output.slice]]
    std::vector<std::string> surfaces;          ///< names of faces, solid boxes and bodies, or all_surfaces
    std::optional<reference_values> reference;  ///< table [output.reference]
  } output;
  std::shared_ptr<case_parts> parts = std::make_shared<case_parts>();  ///< objects made from the keys
};

/// Returns ε as a function of the position in `dimensions` space dimensions. Throws the input errors of
/// expression at the place of the key that gives ε.
expression make_epsilon(const case_config& config, int dimensions);

/// Parses the text of a case file and applies overrides "dotted.key=value". Throws input_error with file,
/// line, column and a suggestion for unknown or missing keys, wrong types, and values out of range.
case_config parse_case(std::string_view text, const std::string& file,
                       const std::vector<std::string>& overrides = {});

/// Returns the text of a case: of a file by path, or of a built-in case by name. Throws
/// input_error or io_error.
std::string read_case(const std::string& name_or_path);

/// Loads a case file by path, or a built-in case by name ("paper/bgk-mixed"), with overrides as in
/// parse_case(). Throws input_error or io_error.
case_config load_case(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

/// Returns the velocities of the case, as its model takes them.
velocity_config velocities_of(const case_config& config);

/// Returns the model of the case with its parameters, made once for a case and its copies. Throws input_error
/// if there is no such model.
std::shared_ptr<const model> make_model(const case_config& config);

/// Returns the place of a key, or of the innermost table around it that has a known place. Without one,
/// the place is empty.
source_place place_of(const case_config& config, const std::string& path);

/// Returns the mesh of the table [space] with its solid boxes and bodies. Throws the input errors of grid,
/// and input_error if a box does not fit.
grid make_mesh(const case_config& config);

/// Returns the names of the built-in cases, sorted.
std::vector<std::string> case_names();

}  // namespace apsis
