#include <apsis/scheme/fifth_order.hpp>

#include <memory>

namespace apsis {
namespace {

class fifth_order final : public reconstruction {
 public:
  explicit fifth_order(const pencil_loops& loops) : loops_(loops) {}

  int ghost_width() const override { return 2; }
  int order() const override { return 5; }
  void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
    loops_.edges(rows, count, width, left, right);
  }
  void outflow_edges(const double* const* rows, int count, int width, const double* forward,
                     double* edge) const override {
    loops_.outflow_edges(rows, count, width, forward, edge);
  }
  double operations(bool both_edges) const override { return loops_.operations(both_edges); }

 private:
  pencil_loops loops_;
};

}  // namespace

std::unique_ptr<reconstruction> make_fifth_order(const pencil_loops& loops) {
  return std::make_unique<fifth_order>(loops);
}

}  // namespace apsis
