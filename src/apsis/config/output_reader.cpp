#include <apsis/config/output_reader.hpp>

#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/list_of_tables.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/mesh/cell_at.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

constexpr long longest_probe = 1'000'000;  ///< largest number of points
constexpr std::size_t longest_name = 64;   ///< of a file, in characters

/// The keys of one table of a list.
struct output_item {
  std::string path;  ///< "output.probe.1"
  source_place place;
  std::map<std::string, const raw_value*> keys;
};

class reader_of_output {
 public:
  reader_of_output(const case_text& text, const model_entry& model, case_config& config)
      : text_(text), on_mesh_(has_space(model)), model_(model.name), config_(config) {}

  void read() {
    for (const auto& item : items_of("probe", {"name", "from", "to", "points"})) add_probe(item);
    for (const auto& item : items_of("slice", {"name", "normal", "at"})) add_slice(item);
    check_points_of_distribution();
    check_surfaces();
  }

 private:
  std::size_t dimensions() const { return config_.space.cells.size(); }

  /// Returns the tables of a list in the order of their numbers.
  std::vector<output_item> items_of(const std::string& list, const std::vector<std::string>& valid) const {
    std::map<std::size_t, output_item> items;
    const std::string head = "output." + list;
    for (const auto& [path, raw] : text_.values) {
      if (path == head) refuse(raw, path, "it is a list of tables", fmt::format("write [[{}]]", path));
      if (path.rfind(head + ".", 0) != 0) continue;
      if (!on_mesh_)
        throw input_error(raw.place, fmt::format("key '{}' is not used (model '{}' has no space); remove it",
                                                 shown(path), model_));
      const auto [number, key] = number_and_key(path, head, list, raw);
      if (std::find(valid.begin(), valid.end(), key) == valid.end())
        throw input_error(raw.place, fmt::format("unknown key '{}' (a {} has no such key); {}", shown(path),
                                                 list, suggest(key, valid)));
      output_item& item = items[number];
      item.path = fmt::format("{}.{}", head, number);
      item.place = raw.place;
      item.keys[key] = &raw;
    }
    std::vector<output_item> all;
    for (auto& [number, item] : items) {
      const auto table = text_.tables.find(item.path);
      if (table != text_.tables.end()) item.place = table->second;
      all.push_back(std::move(item));
    }
    return all;
  }

  static key_of_table number_and_key(const std::string& path, const std::string& head,
                                     const std::string& list, const raw_value& raw) {
    if (auto split = split_key(path, head + ".")) return *std::move(split);
    throw input_error(
        raw.place,
        fmt::format("unknown key '{}' ({} is a list of tables, numbered from 1 to at most {}); write "
                    "[[{}]], or on the command line {}.1.name=middle",
                    shown(path), list, most_listed_tables, head, head));
  }

  void add_probe(const output_item& item) {
    line_probe probe;
    probe.name = name_of(item, "probe", config_.output.probes);
    probe.from = point(key(item, "from", "from = " + example_point()), item.path + ".from");
    probe.to = point(key(item, "to", "to = " + example_point()), item.path + ".to");
    if (probe.from == probe.to)
      refuse(*item.keys.at("to"), item.path + ".to", "it is the same point as 'from'",
             "give the other end of the line");
    if (const auto found = item.keys.find("points"); found != item.keys.end())
      probe.points = static_cast<int>(whole(*found->second, item.path + ".points", 2, longest_probe));
    config_.output.probes.push_back(std::move(probe));
  }

  void add_slice(const output_item& item) {
    plane_slice slice;
    if (dimensions() < 2)
      throw input_error(item.place,
                        fmt::format("'{}' is not possible (a slice needs two or three space dimensions, the "
                                    "case has one); remove it",
                                    item.path));
    slice.name = name_of(item, "slice", config_.output.slices);
    const raw_value& normal = key(item, "normal", "normal = \"x\"");
    const auto* text = std::get_if<std::string>(&normal.value);
    const std::string axes = std::string("xyz").substr(0, dimensions());
    if (text == nullptr || text->size() != 1 || axes.find(*text) == std::string::npos)
      refuse(normal, item.path + ".normal", fmt::format("it must be one of {}", fmt::join(axes, ", ")),
             "write for example normal = \"x\"");
    slice.direction = static_cast<int>(axes.find(*text));
    const raw_value& at = key(item, "at", "at = 0.5");
    slice.at = finite_number(at, item.path + ".at", "a number");
    check_inside(at, item.path + ".at", slice.at, static_cast<std::size_t>(slice.direction));
    config_.output.slices.push_back(std::move(slice));
  }

  const raw_value& key(const output_item& item, const std::string& name, const std::string& example) const {
    const auto found = item.keys.find(name);
    if (found == item.keys.end())
      throw input_error(item.place, fmt::format("key '{}.{}' is missing (every table of the list needs it); "
                                                "add it, for example: {}",
                                                item.path, name, example));
    return *found->second;
  }

  std::string example_point() const {
    std::vector<std::string> middle;
    for (const auto& [lower, upper] : config_.space.domain)
      middle.push_back(fmt::format("{}", 0.5 * lower + 0.5 * upper));
    return fmt::format("[{}]", fmt::join(middle, ", "));
  }

  /// Returns the name of a file, by default such as "probe-1". No name may occur twice.
  template <class Item>
  std::string name_of(const output_item& item, const std::string& list,
                      const std::vector<Item>& earlier) const {
    const auto given = item.keys.find("name");
    std::string name = fmt::format("{}-{}", list, item.path.substr(item.path.rfind('.') + 1));
    if (given != item.keys.end()) {
      const auto* text = std::get_if<std::string>(&given->second->value);
      const auto valid = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
      };
      if (text == nullptr || text->empty() || text->size() > longest_name ||
          !std::all_of(text->begin(), text->end(), valid))
        refuse(*given->second, item.path + ".name",
               fmt::format("the name of a file is needed: 1 to {} letters, digits, - or _", longest_name),
               "write for example name = \"middle\"");
      name = *text;
    }
    if (std::any_of(earlier.begin(), earlier.end(), [&](const Item& one) { return one.name == name; }))
      throw input_error(given != item.keys.end() ? given->second->place : item.place,
                        fmt::format("two tables [[output.{}]] have the name '{}' (they would write the same "
                                    "file); give another name",
                                    list, name));
    return name;
  }

  static long whole(const raw_value& raw, const std::string& path, long lowest, long highest) {
    const double x = finite_number(raw, path, type_text(key_type::integer));
    if (x != std::floor(x))
      refuse(raw, path, type_text(key_type::integer) + " is needed", type_advice(key_type::integer));
    if (x < static_cast<double>(lowest) || x > static_cast<double>(highest))
      refuse(raw, path, fmt::format("it must be at least {} and at most {}", lowest, highest),
             "change it to a value in this range");
    return static_cast<long>(x);
  }

  /// Returns a point of the domain from a list of its coordinates; in one dimension also from a number.
  std::vector<double> point(const raw_value& raw, const std::string& path) const {
    std::vector<double> x;
    if (const auto* list = std::get_if<raw_value::list>(&raw.value)) {
      for (const raw_value& item : *list) x.push_back(finite_number(item, path, "a list of numbers"));
    } else {
      x.push_back(finite_number(raw, path, "a list of numbers"));
    }
    check_point(raw, path, x);
    return x;
  }

  void check_point(const raw_value& raw, const std::string& path, const std::vector<double>& x) const {
    if (x.size() != dimensions())
      refuse(raw, path,
             fmt::format("a point has {} coordinate{} here", dimensions(), dimensions() == 1 ? "" : "s"),
             fmt::format("write for example {}", example_point()));
    for (std::size_t k = 0; k < x.size(); ++k) check_inside(raw, path, x[k], k);
  }

  void check_inside(const raw_value& raw, const std::string& path, double x, std::size_t k) const {
    const auto [lower, upper] = config_.space.domain[k];
    if (x >= lower && x <= upper) return;
    throw input_error(raw.place, fmt::format("'{}' is outside the domain ({} = {} is not in [{}, {}]); give "
                                             "a point inside",
                                             path, "xyz"[k], x, lower, upper));
  }

  void check_points_of_distribution() const {
    const auto& output = config_.output;
    const auto given = text_.values.find("output.distribution_at");
    if (given == text_.values.end()) return;
    const std::string& path = given->first;
    for (const auto& x : output.distribution_at) {
      check_point(given->second, path, x);
      if (const grid mesh = make_mesh(config_); mesh.solid(cell_at(mesh, x)) >= 0)
        throw input_error(given->second.place,
                          fmt::format("'{}' has a point inside a solid ([{}]); give a point in the gas", path,
                                      fmt::join(x, ", ")));
    }
    const char* with = output.distribution == distribution_choice::none ? "output.distribution = \"none\""
                       : output.stride > 1                              ? "output.stride"
                                                                        : nullptr;
    if (with != nullptr)
      throw input_error(given->second.place,
                        fmt::format("'{}' conflicts with {} (both choose the cells in which f is written); "
                                    "remove one of them",
                                    path, with));
  }

  /// Returns the names of the faces that are not periodic, of the solid boxes and of the bodies.
  std::vector<std::string> open_surfaces() const {
    std::vector<std::string> names;
    const auto sides = make_boundaries(config_, make_model(config_));
    for (std::size_t k = 0; k < 2 * sides.size(); ++k)
      if (!sides[k / 2][k % 2]->periodic()) names.push_back(face_names[k]);
    for (const auto& solid : config_.solids) names.push_back(solid.name);
    for (const auto& body : config_.bodies) names.push_back(body.name);
    return names;
  }

  void check_surfaces() const {
    const auto given = text_.values.find("output.surfaces");
    // A resolved case has an empty list if no surfaces are written.
    if (given == text_.values.end() || config_.output.surfaces.empty()) return;
    std::vector<std::string> names = open_surfaces();
    if (names.empty())
      throw input_error(given->second.place,
                        "'output.surfaces' has no meaning (every face is periodic, and there are no solid "
                        "boxes); remove it");
    names.emplace_back(all_surfaces);
    const auto* list = std::get_if<raw_value::list>(&given->second.value);
    for (std::size_t k = 0; k < config_.output.surfaces.size(); ++k) {
      const std::string& name = config_.output.surfaces[k];
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      const bool is_face = std::find(face_names.begin(), face_names.end(), name) <
                           face_names.begin() + 2 * static_cast<std::ptrdiff_t>(dimensions());
      throw input_error(list == nullptr ? given->second.value_place : list->at(k).value_place,
                        fmt::format("unknown surface '{}' in 'output.surfaces' ({}); {}", shown(name),
                                    is_face ? "this face is periodic" : "no face or solid box has this name",
                                    suggest(name, names)));
    }
  }

  const case_text& text_;
  bool on_mesh_;
  std::string model_;
  case_config& config_;
};

}  // namespace

void read_output_tables(const case_text& text, const model_entry& model, case_config& config) {
  reader_of_output(text, model, config).read();
}

}  // namespace apsis
