#include <apsis/device/internal/surface_rows.hpp>

#include <apsis/device/internal/kernels/copy_rows.hpp>
#include <apsis/device/internal/kernels/enter.hpp>
#include <apsis/device/internal/row_launch.hpp>
#include <apsis/device/internal/sweep.hpp>

#include <algorithm>
#include <cstring>
#include <utility>

namespace apsis {
namespace {

std::size_t index(int k) {
  return static_cast<std::size_t>(k);
}

}  // namespace

surface_rows::surface_rows(device& on, const model& equation, std::shared_ptr<domain> space,
                           const limited_reconstruction& edges)
    : device_(on),
      equation_(equation),
      space_(std::move(space)),
      ghosts_(edges.ghosts()),
      faces_(equation, space_),
      mirror_(space_->mesh().size(), equation.components()),
      stride_(index(mirror_.stride())) {
  for (const surface& one : space_->surfaces()) {
    first_at_surface_.push_back(ends_);
    ends_ += one.own;
  }
  if (space_->mesh().cut() != nullptr)
    cut_ = std::make_unique<device_cut_cells>(on, equation, space_, edges, faces_);
  space_->exchange(mirror_);  // so that rows of other processes have their addresses
  number_sent_rows();
  list_inside_rows();
  list_entries();
  const memory_space& memory = device_.memory();
  gathered_ = stored_numbers(inside_.size() * stride_, memory);
  sent_ = stored_numbers(sent_from_.size() * stride_, memory);
  at_ends_ = stored_numbers(index(ends_) * stride_, memory);
  entering_ = stored_numbers(index(ends_) * stride_, memory);
  memory.clear(at_ends_.data(), at_ends_.size());
}

/// Numbers the rows to send. A row beyond an end is a row of the mirror or lies elsewhere on the host; the
/// latter are sent.
void surface_rows::number_sent_rows() {
  std::vector<const double*> rows;
  for (int direction = 0; direction < space_->mesh().dimensions(); ++direction) {
    const auto& segments = space_->segments().along(direction);
    for (int number = 0; number < static_cast<int>(segments.size()); ++number)
      for (const bool upper : {false, true}) {
        const int first = upper ? segments[index(number)].cells : -ghosts_;
        space_->segment_rows(mirror_, direction, number, first, first + ghosts_, rows);
        for (const double* row : rows)
          if ((row < mirror_.row(0) || row >= mirror_.row(mirror_.cells())) &&
              sent_numbers_.emplace(row, static_cast<int>(sent_from_.size())).second)
            sent_from_.push_back(row);
      }
  }
}

/// Lists the rows next to borders with other processes, which need them.
void surface_rows::list_rows_of_others() {
  const grid& mesh = space_->mesh();
  for (int direction = 0; direction < mesh.dimensions(); ++direction) {
    if (!space_->splits(direction)) continue;
    const int cells = mesh.cells(direction);
    for (int pencil = 0; pencil < mesh.pencils(direction); ++pencil)
      for (int k = 0; k < cells; ++k)
        if (k < ghosts_ || k >= cells - ghosts_)
          inside_.push_back(mesh.first_cell(direction, pencil) + k * mesh.stride(direction));
  }
}

/// Lists the rows that boundaries read, as many as there are ghost rows, and at least three. Adds those that
/// cut cells and other processes read.
void surface_rows::list_inside_rows() {
  list_rows_of_others();
  if (cut_) {
    const std::vector<int> read = cut_->on_host().cells_read();
    inside_.insert(inside_.end(), read.begin(), read.end());
  }
  constexpr int least = 3;
  for (int number = 0; number < static_cast<int>(space_->surfaces().size()); ++number) {
    if (space_->repeats(number)) continue;
    const auto& [where, solid, segments, own] = space_->surfaces()[index(number)];
    for (const int one : segments) {
      const segment& along = space_->segment_at(where.direction, one);
      for (int k = 0; k < std::min(along.cells, std::max(ghosts_, least)); ++k)
        inside_.push_back(along.first +
                          (where.upper ? along.cells - 1 - k : k) * space_->mesh().stride(where.direction));
    }
  }
  std::sort(inside_.begin(), inside_.end());
  inside_.erase(std::unique(inside_.begin(), inside_.end()), inside_.end());
  inside_on_device_ = device_array<int>(inside_, device_.memory());
}

/// Returns v·n of every component at a side of cells, with the normal n into the gas.
std::vector<double> surface_rows::speeds_into(const face& where) const {
  std::vector<double> inward;
  for (const double v : equation_.speeds(where.direction)) inward.push_back(where.upper ? -v : v);
  return inward;
}

void surface_rows::list_entries() {
  std::vector<double> inward(space_->surfaces().size() * stride_);
  for (int direction = 0; direction < space_->mesh().dimensions(); ++direction)
    for (const bool upper : {false, true}) {
      entries made{space_->mesh().spacing(direction), {}, {}};
      for (int number = 0; number < static_cast<int>(space_->surfaces().size()); ++number) {
        const auto& [where, solid, segments, own] = space_->surfaces()[index(number)];
        if (where.direction != direction || where.upper != upper || space_->side(number) == nullptr) continue;
        const std::vector<double> row = speeds_into(where);
        std::copy(row.begin(), row.end(),
                  inward.begin() + static_cast<std::ptrdiff_t>(index(number) * stride_));
        for (int place = 0; place < own; ++place)
          if (faces_.prescribes(number, place))
            made.ends.push_back(
                {space_->cell_at(number, place), first_at_surface_[index(number)] + place, number});
      }
      if (made.ends.empty()) continue;
      made.on_device = device_array<std::array<int, 3>>(made.ends, device_.memory());
      entries_.push_back(std::move(made));
    }
  inward_ = stored_numbers(inward.size(), device_.memory());
  if (!inward.empty()) device_.memory().copy_from_host(inward.data(), inward.size(), inward_.data());
}

int surface_rows::row_beyond_end(int direction, int number, bool upper, int distance) const {
  const segment& one = space_->segment_at(direction, number);
  const int cell = upper ? one.cells + distance : -1 - distance;
  const double* row = nullptr;
  space_->segment_rows(mirror_, direction, number, cell, cell + 1, &row);
  if (const auto found = sent_numbers_.find(row); found != sent_numbers_.end()) return -1 - found->second;
  return static_cast<int>((row - mirror_.row(0)) / mirror_.stride());
}

int surface_rows::row_at_end(int direction, int number, bool upper) const {
  const segment& one = space_->segment_at(direction, number);
  const segment_end& end = one.ends[upper ? 1 : 0];
  if (end.surface < 0 || !one.ends_here(upper)) return -1;
  return first_at_surface_[index(end.surface)] + end.place;
}

int surface_rows::seen_beyond(int direction, int number, bool upper, int halo) const {
  const std::size_t side = upper ? 1 : 0;
  const segment* one = &space_->segment_at(direction, number);
  for (int distance = one->beyond[side]; distance < halo;) {
    const segment_end& end = one->ends[side];
    if (end.surface >= 0) return faces_.prescribes(end.surface, end.place) ? distance : halo;
    one = &space_->segment_at(direction, end.place);
    distance += one->cells + one->beyond[side];
  }
  return halo;
}

void surface_rows::fill(double t, const field& u) {
  if (inside_.empty()) return;
  const memory_space& memory = device_.memory();
  device_.launch<kernels::copy_rows>(launch_for(inside_.size() * stride_),
                                     {u.row(0), inside_on_device_.data(), gathered_.data(),
                                      static_cast<long>(stride_), static_cast<long>(inside_.size())});
  staged_.resize(gathered_.size());
  memory.copy_to_host(gathered_.data(), gathered_.size(), staged_.data());
  for (std::size_t k = 0; k < inside_.size(); ++k)
    std::memcpy(mirror_.row(inside_[k]), staged_.data() + k * stride_, stride_ * sizeof(double));
  if (cut_) cut_->on_host().prepare(mirror_);
  space_->fill_ghosts(t, mirror_);
  staged_.resize(sent_.size());
  for (std::size_t k = 0; k < sent_from_.size(); ++k)
    std::memcpy(staged_.data() + k * stride_, sent_from_[k], stride_ * sizeof(double));
  if (!staged_.empty()) memory.copy_from_host(staged_.data(), staged_.size(), sent_.data());
}

/// Returns the values that enter a cell at an end of a segment; null if the sweep has added their flux.
const double* surface_rows::entering(int surface, int place, double t) {
  if (space_->is_border_of_cut_cells(surface)) return cut_->on_host().entering(surface, place, mirror_);
  return faces_.enter(surface, place, t);
}

void surface_rows::complete(double t, std::span<const target<field, double>> targets) {
  if (ends_ == 0) return;
  const memory_space& memory = device_.memory();
  staged_.resize(at_ends_.size());
  memory.copy_to_host(at_ends_.data(), at_ends_.size(), staged_.data());
  bool enters = false;
  for (int number = 0; number < static_cast<int>(space_->surfaces().size()); ++number) {
    if (space_->side(number) == nullptr) continue;
    for (int place = 0; place < space_->surfaces()[index(number)].own; ++place) {
      double* row = staged_.data() + index(first_at_surface_[index(number)] + place) * stride_;
      std::memcpy(faces_.recorded(number, place), row, stride_ * sizeof(double));
      if (const double* values = entering(number, place, t); values != nullptr) {
        std::memcpy(row, values, stride_ * sizeof(double));
        enters = true;
      }
      if (!space_->is_border_of_cut_cells(number)) faces_.account(number, place);
    }
  }
  if (!enters) return;
  memory.copy_from_host(staged_.data(), staged_.size(), entering_.data());
  for (const entries& one : entries_)
    for (const auto& to : targets)
      device_.launch<kernels::enter>(
          launch_for(one.ends.size() * stride_),
          {to.acc->row(0), entering_.data(), inward_.data(), one.on_device.data()->data(),
           static_cast<long>(stride_), static_cast<long>(one.ends.size()), to.beta, one.spacing});
}

}  // namespace apsis
