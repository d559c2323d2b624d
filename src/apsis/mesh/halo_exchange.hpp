#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/mesh/distribution.hpp>
#include <apsis/mesh/field.hpp>

#include <array>
#include <memory>
#include <vector>

namespace apsis {

/// The halo of a block: whole rows of the cells of other processes that continue its pencils, received before
/// they are read. Sweeps along one direction at a time read no cells beyond edges and corners of the block,
/// which are not sent.
class halo_exchange {
 public:
  /// `periodic`: of each direction; `width`: number of cells at either end of a pencil.
  halo_exchange(const distribution& of, const std::array<bool, 3>& periodic, int width);
  ~halo_exchange();
  halo_exchange(const halo_exchange&) = delete;
  halo_exchange& operator=(const halo_exchange&) = delete;

  /// Starts to send the rows of u that others need, and to receive theirs. Collective.
  void begin(const field& u);
  /// Lets them advance during other work; for the thread that communicates.
  void advance() const {
    if (under_way_) of_.processes->advance_exchange();
  }
  /// Waits until they are received; without effect if nothing was begun.
  void finish();

  /// Whether pencils along a direction are continued by other processes.
  bool splits(int direction) const { return lines_[static_cast<std::size_t>(direction)].split; }
  /// Returns the row of the cell `ghost` = 0 … width − 1, counted outwards from the lower or upper border of
  /// the block, on a pencil of a direction that is split; u is the field of begin().
  const double* row(const field& u, int direction, int pencil, bool upper, int ghost) const;

 private:
  /// A plane of cells across a direction: one of the block, or received into a buffer.
  struct plane_source {
    int own = -1;       ///< its cell along the direction in the block; −1: received
    int peer = -1;      ///< number of the peer that sends it
    int received = -1;  ///< its place among the planes of this peer
  };
  /// A process with which planes are exchanged.
  struct peer {
    int rank;
    std::vector<int> wanted,  ///< global numbers of the planes that it sends, increasing
        given;  ///< local numbers of the planes that it gets, in the order of their global numbers
    aligned_vector<double> received, sent;
  };
  /// The pencils along one direction.
  struct line {
    bool split = false;
    std::array<std::vector<plane_source>, 2> beyond;  ///< [upper][ghost]
    std::vector<peer> peers;
  };

  void plan(int direction, bool periodic);
  std::vector<int> planes_beyond(int direction, int block, bool periodic, bool upper) const;
  void pack(const field& u, int direction, peer& to) const;
  double numbers_sent() const;

  distribution of_;
  grid mesh_;
  int width_, stride_ = 0;
  std::array<line, 3> lines_;
  bool under_way_ = false;
};

}  // namespace apsis
