#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/config/surface_tables.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/model/model_registry.hpp>

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace apsis {

/// A value that is made once for a key, and made again only for another key. Thread-safe.
template <class Key, class Value>
class made_once {
 public:
  /// Returns the stored value if it belongs to `key`. Otherwise stores and returns the value of
  /// make(), which may throw.
  template <class Make>
  Value get(Key key, const Make& make) {
    const std::lock_guard lock(mutex_);
    if (!key_ || !(*key_ == key)) {
      key_.reset();
      value_ = make();
      key_ = std::move(key);
    }
    return value_;
  }

 private:
  std::mutex mutex_;
  std::optional<Key> key_;
  Value value_{};
};

/// Objects that are made once for reading, checking and running a case. Copies of a case share them. A case
/// with changed keys gets new ones.
struct case_parts {
  /// The entry of a model, and the values from which it is made.
  using model_key = std::pair<const model_entry*, model_config>;
  made_once<model_key, std::shared_ptr<const model>> equation;  ///< make_model()

  /// The model, the kind of sides without their own kind, the tables of sides (or of boxes and bodies), and
  /// the constants of their formulas.
  template <class Tables>
  using surface_key = std::tuple<std::shared_ptr<const model>, std::string, Tables, formula_constants>;
  made_once<surface_key<std::array<face_table, 6>>, std::vector<domain::faces>> sides;  ///< make_boundaries()
  made_once<surface_key<std::pair<std::vector<solid_table>, std::vector<body_table>>>,
            std::vector<std::shared_ptr<const boundary>>>
      walls;  ///< make_solid_walls()

  /// The mesh, the boxes, the bodies, the periodic directions, and the constants of formulas.
  using body_key = std::tuple<std::vector<int>, std::vector<std::array<double, 2>>, std::vector<solid_table>,
                              std::vector<body_table>, std::array<bool, 3>, formula_constants>;
  made_once<body_key, std::shared_ptr<const cut_cells>> cut;  ///< cut_cells_of()
};

}  // namespace apsis
