#include <apsis/mesh/halo_exchange.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>

#include <algorithm>
#include <cstddef>
#include <set>

namespace apsis {
namespace {

constexpr int outside = -1;

}  // namespace

halo_exchange::halo_exchange(const distribution& of, const std::array<bool, 3>& periodic, int width)
    : of_(of), mesh_(of.block()), width_(width) {
  for (int k = 0; k < mesh_.dimensions(); ++k)
    if (of_.blocks.blocks(k) > 1) plan(k, periodic[at(k)]);
}

halo_exchange::~halo_exchange() {
  finish();
}

/// Returns the global numbers of the planes beyond a block, counted outwards; `outside` beyond a face of
/// the domain.
std::vector<int> halo_exchange::planes_beyond(int direction, int block, bool periodic, bool upper) const {
  std::array<int, 3> place{};
  place[at(direction)] = block;
  const cell_box box = of_.blocks.box(of_.blocks.rank(place));
  const int n = of_.whole.cells(direction), first = box.first[at(direction)],
            last = first + box.cells[at(direction)] - 1;
  std::vector<int> planes;
  for (int ghost = 0; ghost < width_; ++ghost) {
    const int cell = upper ? last + 1 + ghost : first - 1 - ghost;
    if (periodic)
      planes.push_back(((cell % n) + n) % n);
    else
      planes.push_back(cell < 0 || cell >= n ? outside : cell);
  }
  return planes;
}

void halo_exchange::plan(int direction, bool periodic) {
  line& along = lines_[at(direction)];
  along.split = true;
  const auto here = of_.blocks.place(of_.processes->rank());
  const int mine = here[at(direction)], first = mesh_.first(direction);
  for (int block = 0; block < of_.blocks.blocks(direction); ++block) {
    if (block == mine) continue;
    auto place = here;
    place[at(direction)] = block;
    std::set<int> wanted, given;
    for (const bool upper : {false, true}) {
      for (const int cell : planes_beyond(direction, mine, periodic, upper))
        if (cell != outside && of_.blocks.block_of(direction, cell) == block) wanted.insert(cell);
      for (const int cell : planes_beyond(direction, block, periodic, upper))
        if (cell != outside && of_.blocks.block_of(direction, cell) == mine) given.insert(cell - first);
    }
    if (wanted.empty() && given.empty()) continue;
    along.peers.push_back(
        {of_.blocks.rank(place), {wanted.begin(), wanted.end()}, {given.begin(), given.end()}, {}, {}});
  }
  for (const bool upper : {false, true})
    for (const int cell : planes_beyond(direction, mine, periodic, upper)) {
      plane_source& one = along.beyond[upper ? 1 : 0].emplace_back();
      if (cell == outside) continue;
      if (of_.blocks.block_of(direction, cell) == mine) one.own = cell - first;
      for (std::size_t p = 0; p < along.peers.size(); ++p) {
        const auto& wanted = along.peers[p].wanted;
        const auto found = std::lower_bound(wanted.begin(), wanted.end(), cell);
        if (found == wanted.end() || *found != cell) continue;
        one.peer = static_cast<int>(p);
        one.received = static_cast<int>(found - wanted.begin());
      }
    }
}

void halo_exchange::pack(const field& u, int direction, peer& to) const {
  const int pencils = mesh_.pencils(direction), apart = mesh_.stride(direction);
  constexpr int pencils_of_task = 32;
  for (std::size_t k = 0; k < to.given.size(); ++k) {
    double* plane = to.sent.data() + k * at(pencils) * at(stride_);
    const int cell = to.given[k];
    parallel_blocks(pencils, pencils_of_task, [&](int begin, int end) {
      for (int pencil = begin; pencil < end; ++pencil)
        std::copy_n(u.row(mesh_.first_cell(direction, pencil) + cell * apart), stride_,
                    plane + at(pencil) * at(stride_));
    });
  }
}

double halo_exchange::numbers_sent() const {
  double rows = 0.0;
  for (int direction = 0; direction < mesh_.dimensions(); ++direction)
    for (const peer& other : lines_[at(direction)].peers)
      rows += static_cast<double>(other.given.size()) * mesh_.pencils(direction);
  return rows * stride_;
}

void halo_exchange::begin(const field& u) {
  finish();
  stride_ = u.stride();
  // Packing reads and writes every number.
  const profile::section timed(kernel::halo, numbers_sent(), {0.0, 2.0 * sizeof(double)});
  std::vector<message> sent, received;
  for (int direction = 0; direction < mesh_.dimensions(); ++direction) {
    const std::size_t plane = at(mesh_.pencils(direction)) * at(stride_);
    for (peer& other : lines_[at(direction)].peers) {
      other.sent.resize(std::max(other.sent.size(), plane * other.given.size()));
      other.received.resize(std::max(other.received.size(), plane * other.wanted.size()));
      pack(u, direction, other);
      if (!other.given.empty()) sent.push_back({other.rank, {other.sent.data(), plane * other.given.size()}});
      if (!other.wanted.empty())
        received.push_back({other.rank, {other.received.data(), plane * other.wanted.size()}});
    }
  }
  of_.processes->begin_exchange(sent, received);
  under_way_ = true;
}

void halo_exchange::finish() {
  if (!under_way_) return;
  under_way_ = false;
  const profile::section waited(kernel::halo, 0.0, {});
  of_.processes->finish_exchange();
}

const double* halo_exchange::row(const field& u, int direction, int pencil, bool upper, int ghost) const {
  const line& along = lines_[at(direction)];
  const plane_source& one = along.beyond[upper ? 1 : 0][at(ghost)];
  if (one.own >= 0) return u.row(mesh_.first_cell(direction, pencil) + one.own * mesh_.stride(direction));
  return along.peers[at(one.peer)].received.data() +
         (at(one.received) * at(mesh_.pencils(direction)) + at(pencil)) * at(stride_);
}

}  // namespace apsis
