#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/mesh/grid.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <support/processes.hpp>

/// Compares 2u + 0.01 T(u) and the forward Euler step of a flow on blocks with those on the whole mesh, bit
/// for bit. make_part(processes) returns the flow of a process. Throws if they differ.
template <class Flow, class MakePart>
void check_blocks(const Flow& whole, const apsis::field& u, const std::array<int, 3>& blocks,
                  const MakePart& make_part) {
  const apsis::field expected = whole.step(u, 2.0, 0.01);
  const double step = whole.problem->forward_euler_step(0.0, u);
  const int count = blocks[0] * blocks[1] * blocks[2];
  threads_as_processes::run(count, [&](const std::shared_ptr<apsis::communicator>& processes) {
    const Flow part = make_part(processes);
    const apsis::grid& block = part.mesh();
    apsis::field own(block.size(), u.components());
    for (int cell = 0; cell < block.size(); ++cell)
      std::copy_n(u.row(whole.mesh().cell_of(block, cell)), u.stride(), own.row(cell));
    if (part.problem->forward_euler_step(0.0, own) != step) throw std::runtime_error("another step");
    const apsis::field found = part.step(own, 2.0, 0.01);
    for (int cell = 0; cell < block.size(); ++cell) {
      const double* there = expected.row(whole.mesh().cell_of(block, cell));
      if (block.solid(cell) < 0 && !std::equal(there, there + u.components(), found.row(cell)))
        throw std::runtime_error(fmt::format("cell {} of process {} differs", cell, processes->rank()));
    }
  });
}
