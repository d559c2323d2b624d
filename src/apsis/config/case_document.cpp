// Documentation of the schema and cases as text, both generated from the table of keys.
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/core/word_wrap.hpp>

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (byte < 32 || byte == 127)
      out += fmt::format("\\u{:04X}", byte);
    else
      out += c;
  }
  return out + "\"";
}

// Returns the shortest decimal that is read back unchanged, as a TOML float.
std::string number_text(double x) {
  const std::string text = fmt::format("{}", x);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

struct to_toml_visitor {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(long x) const { return fmt::format("{}", x); }
  std::string operator()(double x) const { return number_text(x); }
  std::string operator()(const std::string& x) const { return quoted(x); }
  std::string operator()(const std::vector<std::string>& x) const {
    std::vector<std::string> items;
    for (const auto& item : x) items.push_back(quoted(item));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  // A list of one item is written as this item.
  std::string operator()(const std::vector<long>& x) const {
    return x.size() == 1 ? (*this)(x.front()) : fmt::format("[{}]", fmt::join(x, ", "));
  }
  std::string operator()(const std::vector<interval>& x) const {
    std::vector<std::string> items;
    for (const auto& [lower, upper] : x)
      items.push_back(fmt::format("[{}, {}]", number_text(lower), number_text(upper)));
    return items.size() == 1 ? items.front() : fmt::format("[{}]", fmt::join(items, ", "));
  }
  std::string operator()(const std::vector<double>& x) const {
    std::vector<std::string> items;
    for (const double item : x) items.push_back(number_text(item));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  std::string operator()(const std::vector<std::vector<double>>& x) const {
    std::vector<std::string> items;
    for (const auto& item : x) items.push_back((*this)(item));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
};

std::string table_of(const std::string& path) {
  const auto dot = path.find('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

std::string name_of(const std::string& path) {
  return path.substr(path.find('.') + 1);
}

std::string scope_text(key_scope scope) {
  switch (scope) {
    case key_scope::always:
      return "";
    case key_scope::space:
      return "models with space";
    case key_scope::velocity:
      return "models with a velocity grid";
  }
  return "";
}

// Returns indented lines of at most 100 characters.
std::string indented(const std::string& text) {
  constexpr std::size_t indent = 6;
  std::string out;
  for (const auto& line : word_wrap(text, 100 - indent)) out += std::string(indent, ' ') + line + "\n";
  return out;
}

std::string default_text(const case_key& key) {
  if (key.required) return "required";
  const case_value value = key.load(case_config{});
  if (std::holds_alternative<std::monostate>(value)) return "not set";
  if (key.path == "model.initial") return "the model's first";
  if (key.path == "model.epsilon") return "default " + std::get<std::string>(value);
  return "default " + to_toml(value);
}

std::string key_text(const case_key& key) {
  std::string facts = type_text(key.type).substr(type_text(key.type).find(' ') + 1);
  const auto add = [&facts](const std::string& fact) {
    if (!fact.empty()) facts += ", " + fact;
  };
  add(range_text(key));
  add(key.unit);
  add(default_text(key));
  add(scope_text(key.scope));
  std::string out = fmt::format("  {} ({})\n", name_of(key.path), facts);
  out += indented(key.doc);
  // Names of initial data are listed with their model.
  if (key.choices && key.path != "model.initial")
    out += indented(fmt::format("one of: {}", fmt::join(key.choices(case_config{}), ", ")));
  return out;
}

std::string describe(const model_entry& model) {
  std::string out = fmt::format("  {}: {}\n", model.name, model.description);
  std::string tables =
      has_space(model) ? (model.has_velocity_grid ? "space, velocity" : "space") : "none but time, output";
  out += fmt::format("      tables: {}; initial data: {}\n", tables, fmt::join(initial_names(model), ", "));
  for (const data_form& form : prototype(model).data_forms()) {
    std::vector<std::string> variables;
    for (const data_variable& v : form.variables)
      variables.push_back(
          fmt::format("{}, {}{}", v.name, v.doc, v.value ? fmt::format(" [{}]", *v.value) : ""));
    out += indented(fmt::format("[initial] ({}): {}", form.description, fmt::join(variables, "; ")));
  }
  for (const model_list& l : model.lists)
    out += indented(fmt::format("{} (list of {}, default {}): {}", l.name,
                                l.tuples ? "lists of numbers"
                                : l.variables.empty()
                                    ? "names"
                                    : fmt::format("formulas in the names of '{}'", l.variables),
                                to_toml(case_value(l.value)), l.doc));
  for (const model_parameter& p : model.parameters)
    out += indented(fmt::format("{} (number, {} to {}{}): {}", p.name, p.lowest, p.highest,
                                p.automatic ? fmt::format(", or \"{0}\"; default \"{0}\"", automatic_word)
                                            : fmt::format(", default {}", p.value),
                                p.doc));
  for (const model_option& t : model.options)
    out += indented(fmt::format(
        "{} (text, one of {}{}, default \"{}\"): {}", t.name, fmt::join(t.choices, ", "),
        t.variable.empty() ? "" : fmt::format(", or a formula in {}", t.variable), t.value, t.doc));
  return out;
}

}  // namespace

std::string to_toml(const case_value& value) {
  return std::visit(to_toml_visitor{}, value);
}

std::string schema_text() {
  std::string out =
      "Keys of a case file (TOML). A key that is not listed, or that the model does not use, is an error.\n"
      "On the command line: apsis run CASE key=value, for example space.cells=80; there a number may be a\n"
      "fraction, time.dt=1/128.\n";
  std::string table = "?";
  for (const case_key& key : case_schema()) {
    if (table_of(key.path) != table) {
      table = table_of(key.path);
      out += table.empty() ? "\n" : fmt::format("\n[{}]\n", table);
    }
    out += key_text(key);
  }
  out +=
      "\n[parameters]\n"
      "  NAME (number)\n"
      "      A constant of all formulas of the case; on the command line parameters.NAME=2.\n"
      "\n[initial], in place of model.initial\n"
      "  rho, u, T, … (number or formula in x, y, z; a list for a vector)\n"
      "      The variables of the model, listed below with their defaults in brackets.\n"
      "  file (text)\n"
      "      In place of the variables: an earlier result (solution.h5, fields.csv), or a table of yours, "
      ".csv\n"
      "      or .h5, with x and the variables as cell averages (relative to where the program runs).\n"
      "  time (number)\n"
      "      Time of the snapshot of the file, the last one if not given.\n"
      "  [[initial.part]]: weight (formula, default 1) and variables\n"
      "      A term of a sum of states; a sum replaces the variables of [initial].\n"
      "  [[initial.region]]: where (condition, \"x < 0.5\") and variables or [[initial.region.part]]\n"
      "      Replaces variables of the state below where the condition holds; the last region is uppermost.\n"
      "\n[[space.solid]], of models with space\n"
      "  from, to (list of numbers or formulas without variables)\n"
      "      Lower and upper corner of a solid box, on edges of cells. Boxes may touch and overlap.\n"
      "  kind (text, default \"diffuse\") and its variables (apsis list boundaries)\n"
      "      Boundary condition at the faces of the box, with numbers, formulas in t and the position, or\n"
      "      tables in time as in [boundary.left].\n"
      "  name (text, default \"solid-1\", …)\n"
      "      Names the columns of the history for what its walls give to the gas.\n"
      "\n[[space.body]], in two and three space dimensions\n"
      "  shape (text) and its keys (apsis list shapes)\n"
      "      Shape of a body that cuts cells, with numbers or formulas without variables. Lists of tables "
      "are\n"
      "      shapes that it combines: shapes = [{ shape = \"circle\", ... }, ...].\n"
      "  kind (text, default \"diffuse\") and its variables (apsis list boundaries)\n"
      "      Boundary condition at its wall, with numbers, formulas in t and the position, or tables in "
      "time.\n"
      "  name (text, default \"body-1\", …)\n"
      "      Names the columns of the history for what its wall gives to the gas.\n"
      "\n[[output.probe]], of models with space\n"
      "  name (text, default \"probe-1\", ...), from, to (points [x, y, z]), points (integer, default 101)\n"
      "      The fields along the line between two points, interpolated linearly, in probes/NAME.csv.\n"
      "\n[[output.slice]], in two and three space dimensions\n"
      "  name (text, default \"slice-1\", ...), normal (\"x\", \"y\" or \"z\"), at (number)\n"
      "      The fields on a plane, in slices/NAME.h5 and slices/NAME.xdmf.\n"
      "\n[output.reference], of gases in two and three space dimensions\n"
      "      The stream and the size to which coefficients of bodies and walls refer (docs/bodies.md).\n";
  for (const reference_key& key : reference_keys())
    out += fmt::format("  {} ({}, {}{})\n      {}.\n", key.name, key.vector != nullptr ? "vector" : "number",
                       key.required ? "required" : "optional",
                       key.only_in == 0 ? "" : fmt::format("; in {} dimensions", key.only_in), key.doc);
  out +=
      "\n[source], of models with space\n"
      "  rho, u, T, … (number or formula in t and x; a list for a vector)\n"
      "      Variables of the model per unit of time: rho is the mass that enters with the velocity u and "
      "the\n"
      "      temperature T.\n"
      "  f (formula in t, x and v_x, v_y, v_z)\n"
      "      In place of them, of a gas; g and h where degrees_of_freedom exceeds velocity_dimensions.\n"
      "\nModels, and the parameters that [model] takes for them\n";
  for (const model_entry* model : model_entries()) out += describe(*model);
  return out;
}

namespace {

/// Returns a formula in quotes. A table in time has several lines, broken after commas.
/// TOML joins them again.
std::string quoted_formula(const std::string& formula) {
  constexpr std::size_t longest = 200, of_a_line = 90;
  if (formula.size() <= longest || formula.find_first_of("\"\\") != std::string::npos) return quoted(formula);
  std::string out = "\"\"\"";
  for (std::size_t begin = 0; begin < formula.size();) {
    const std::size_t comma = formula.find(", ", std::min(begin + of_a_line, formula.size()));
    const std::size_t end = comma == std::string::npos ? formula.size() : comma + 2;
    out.append(formula, begin, end - begin);
    if (end < formula.size()) out += "\\\n  ";
    begin = end;
  }
  return out + "\"\"\"";
}

void add_state(std::string& out, const state_formulas& state) {
  for (const auto& [name, formulas] : state) {
    std::vector<std::string> texts;
    for (const auto& formula : formulas) texts.push_back(quoted_formula(formula));
    const std::string list = fmt::format("{}", fmt::join(texts, ", "));
    out +=
        formulas.size() == 1 ? fmt::format("{} = {}\n", name, list) : fmt::format("{} = [{}]\n", name, list);
  }
}

void add_parts(std::string& out, const std::string& table, const std::vector<initial_part>& parts) {
  for (const auto& part : parts) {
    out += fmt::format("\n[[{}.part]]\nweight = {}\n", table, quoted(part.weight));
    add_state(out, part.state);
  }
}

void add_initial_table(std::string& out, const initial_table& initial) {
  if (initial.empty()) return;
  out += "\n[initial]\n";
  if (initial.from_python) out += "from = \"python\"\n";
  if (!initial.file.empty()) out += fmt::format("file = {}\n", quoted(initial.file));
  if (initial.time) out += fmt::format("time = {}\n", number_text(*initial.time));
  add_state(out, initial.state);
  add_parts(out, "initial", initial.parts);
  for (const auto& region : initial.regions) {
    out += fmt::format("\n[[initial.region]]\nwhere = {}\n", quoted(region.where));
    add_state(out, region.state);
    add_parts(out, "initial.region", region.parts);
  }
}

std::string numbers_text(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double x : numbers) texts.push_back(number_text(x));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// Returns the keys of a shape and their values in TOML.
std::vector<std::pair<std::string, std::string>> entries_of(const shape_table& table) {
  const auto list = [](const std::vector<double>& numbers) { return "[" + numbers_text(numbers) + "]"; };
  struct text_of {
    decltype(list)& as_list;
    std::string operator()(double number) const { return number_text(number); }
    std::string operator()(const std::vector<double>& vector) const { return as_list(vector); }
    std::string operator()(const std::vector<std::vector<double>>& points) const {
      std::vector<std::string> all;
      for (const auto& one : points) all.push_back(as_list(one));
      return fmt::format("[{}]", fmt::join(all, ", "));
    }
    std::string operator()(const std::string& text) const { return quoted(text); }
  };
  std::vector<std::pair<std::string, std::string>> all = {{"shape", quoted(table.shape)}};
  for (const auto& [key, value] : table.values) all.emplace_back(key, std::visit(text_of{list}, value));
  for (const auto& [key, parts] : table.parts) {
    std::vector<std::string> texts;
    for (const shape_table& part : parts) {
      std::vector<std::string> inner;
      for (const auto& [name, value] : entries_of(part)) inner.push_back(fmt::format("{} = {}", name, value));
      texts.push_back(fmt::format("{{ {} }}", fmt::join(inner, ", ")));
    }
    all.emplace_back(key, fmt::format("[{}]", fmt::join(texts, ", ")));
  }
  return all;
}

void add_face(std::string& out, const std::string& side, const face_table& table) {
  if (!table.kind && table.values.empty()) return;
  out += fmt::format("\n[boundary.{}]\n", side);
  if (table.kind) out += fmt::format("kind = {}\n", quoted(*table.kind));
  add_state(out, table.values);
}

void add_output_tables(std::string& out, const case_config& config) {
  const to_toml_visitor text;
  for (const auto& probe : config.output.probes)
    out += fmt::format("\n[[output.probe]]\nname = {}\nfrom = {}\nto = {}\npoints = {}\n", quoted(probe.name),
                       text(probe.from), text(probe.to), probe.points);
  for (const auto& slice : config.output.slices)
    out += fmt::format("\n[[output.slice]]\nname = {}\nnormal = \"{}\"\nat = {}\n", quoted(slice.name),
                       "xyz"[slice.direction], number_text(slice.at));
  if (const auto& reference = config.output.reference) {
    out += "\n[output.reference]\n";
    for (const reference_key& key : reference_keys()) {
      if (key.vector != nullptr && !((*reference).*key.vector).empty())
        out += fmt::format("{} = {}\n", key.name, text((*reference).*key.vector));
      if (key.number != nullptr && (*reference).*key.number != 0.0)
        out += fmt::format("{} = {}\n", key.name, number_text((*reference).*key.number));
    }
  }
}

}  // namespace

std::string to_toml(const case_config& config) {
  const model_entry* model = try_find_model(config.model.name);
  std::string out, table;
  // Parameters are the last keys of [model], written before the next table.
  const auto close_table = [&] {
    if (table != "model") return;
    for (const auto& [name, value] : config.model.parameters)
      out += fmt::format("{} = {}\n", name, number_text(value));
    for (const auto& [name, value] : config.model.options)
      out += fmt::format("{} = {}\n", name, quoted(value));
    for (const auto& [name, value] : config.model.lists)
      out += fmt::format("{} = {}\n", name, to_toml(case_value(value)));
  };
  const auto add_constants = [&] {
    if (config.constants.empty()) return;
    out += "\n[parameters]\n";
    for (const auto& [name, value] : config.constants)
      out += fmt::format("{} = {}\n", name, number_text(value));
  };
  for (const case_key& key : case_schema()) {
    const case_value value = key.load(config);
    if ((model != nullptr && !applies(key, *model)) || std::holds_alternative<std::monostate>(value) ||
        (key.path == "model.initial" && !config.prescribed.empty()) || key.path.rfind("boundary.", 0) == 0)
      continue;
    if (table_of(key.path) != table) {
      if (table.empty()) add_constants();
      close_table();
      table = table_of(key.path);
      out += fmt::format("\n[{}]\n", table);
    }
    out += fmt::format("{} = {}\n", name_of(key.path), to_toml(value));
  }
  add_initial_table(out, config.prescribed);
  for (std::size_t k = 0; k < config.faces.size(); ++k) add_face(out, face_names[k], config.faces[k]);
  for (const auto& solid : config.solids) {
    out +=
        fmt::format("\n[[space.solid]]\nname = {}\nfrom = [{}]\nto = [{}]\nkind = {}\n", quoted(solid.name),
                    numbers_text(solid.from), numbers_text(solid.to), quoted(solid.kind));
    add_state(out, solid.values);
  }
  for (const auto& body : config.bodies) {
    out += fmt::format("\n[[space.body]]\nname = {}\nkind = {}\n", quoted(body.name), quoted(body.kind));
    for (const auto& [key, value] : entries_of(body.shape)) out += fmt::format("{} = {}\n", key, value);
    add_state(out, body.values);
  }
  if (!config.source_term.empty()) {
    out += "\n[source]\n";
    add_state(out, config.source_term);
  }
  add_output_tables(out, config);
  return out;
}

}  // namespace apsis
