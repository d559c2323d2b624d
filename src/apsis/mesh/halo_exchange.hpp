#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/mesh/distribution.hpp>
#include <apsis/mesh/field.hpp>

#include <array>
#include <memory>
#include <vector>

namespace apsis {

/// The halo of a block: whole rows of the cells of other processes that continue its pencils. Cells beyond
/// edges and corners of the block are not exchanged, because sweeps along single directions do not read them.
class halo_exchange {
 public:
  /// Plans the exchange. `periodic` has a flag for each direction. `width` is the number of cells of the halo
  /// at either end of a pencil.
  halo_exchange(const distribution& of, const std::array<bool, 3>& periodic, int width);
  ~halo_exchange();
  halo_exchange(const halo_exchange&) = delete;
  halo_exchange& operator=(const halo_exchange&) = delete;

  /// Starts to send the rows of u that other processes need, and to receive their rows. Collective.
  void begin(const field& u);
  /// Advances the exchange during other work. Only the thread that communicates may call it.
  void advance() const {
    if (under_way_) of_.processes->advance_exchange();
  }
  /// Waits until the rows are received. Without effect if no exchange was started.
  void finish();

  /// Whether the cells of a direction are divided among several processes.
  bool splits(int direction) const { return lines_[static_cast<std::size_t>(direction)].split; }
  /// Returns the row of a halo cell on a pencil of a split direction. `ghost` = 0 … width − 1 counts outwards
  /// from the lower or upper border of the block. u is the field of begin().
  const double* row(const field& u, int direction, int pencil, bool upper, int ghost) const;

 private:
  /// A plane of cells across a direction, either of the block or received into a buffer.
  struct plane_source {
    int own = -1;       ///< number along the direction in the block; −1 for a received plane
    int peer = -1;      ///< number of the peer that sends the plane
    int received = -1;  ///< place of the plane among those of this peer
  };
  /// A process that exchanges planes with this one.
  struct peer {
    int rank;
    std::vector<int> wanted,  ///< global numbers of the planes that the peer sends, increasing
        given;  ///< local numbers of the planes that the peer receives, in the order of their global numbers
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
