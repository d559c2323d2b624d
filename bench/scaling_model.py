"""Predicts the efficiency of runs on many cores from measurements on one machine (docs/scaling.md).

A step of a process with n^D cells takes
    n^D N t / c + max(0, E (2 D L + S/B) - inner work) + E S/M + R L log2(P),
with N numbers of a cell, t seconds for a number on one core, c cores, E exchanges and R reductions of a step, S = 2 D w n^(D-1) N 8 bytes
received in an exchange, latency L, bandwidth B, and bandwidth M of the memory for packing. Of the faces of a block those towards
other nodes use the network.
"""
import math
from dataclasses import dataclass

HALO = 4  # cells, of WENO with the limiter


@dataclass(frozen=True)
class Network:
    """Two endpoints of a message on different nodes."""
    latency: float = 1.5e-6     # s
    bandwidth: float = 25e9     # bytes/s of a node, each way
    cores_of_node: int = 128
    memory: float = 2e9         # bytes/s that one core packs


@dataclass(frozen=True)
class Gas:
    name: str
    dimensions: int
    numbers: int      # of a cell
    seconds: float    # of a number and step on one core
    exchanges: float  # of a step
    reductions: float


def gas_of(entry):
    return Gas(entry["name"], entry["dimensions"], entry["components"], entry["seconds_per_point"], entry["exchanges"], entry["reductions"])


def faces_to_other_nodes(gas, of_node, compact):
    """The mean number of faces of a block beyond which another node is: blocks of a node in a row along the last direction, in which two
    of all their faces leave the node, or in a cube."""
    if compact:
        return 2.0 * gas.dimensions / of_node ** (1.0 / gas.dimensions)
    return 2.0 * (gas.dimensions - 1) + 2.0 / of_node


def seconds_of_step(gas, network, side, cores, threads, compact=False):
    """Computing, exposed messages, packing and reductions, in seconds, of a process with `threads` cores and side^D cells."""
    processes = cores // threads
    cells = side ** gas.dimensions
    computing = cells * gas.numbers * gas.seconds / threads
    face = HALO * side ** (gas.dimensions - 1) * gas.numbers * 8.0
    of_node = max(1, network.cores_of_node // threads)
    outer = 0.0 if processes <= of_node else faces_to_other_nodes(gas, of_node, compact)
    messages = gas.exchanges * (2.0 * gas.dimensions * network.latency + outer * face / (network.bandwidth / of_node))
    inner = max(0.0, 1.0 - 2.0 * HALO / side) ** gas.dimensions * computing
    packing = gas.exchanges * 2.0 * gas.dimensions * face / (network.memory * threads)
    reductions = gas.reductions * network.latency * math.ceil(math.log2(max(2, processes)))
    return computing, max(0.0, messages - inner), packing, reductions


def efficiency(gas, network, side, cores, threads, compact=False):
    parts = seconds_of_step(gas, network, side, cores, threads, compact)
    return parts[0] / sum(parts)


def tables(measured, network=Network()):
    """Markdown tables of weak and strong scaling."""
    cores = [128, 1024, 10_000, 100_000]
    sides = {2: (200, 60, 20), 3: (40, 20, 10)}
    totals = {2: 6_000, 3: 300}  # cells in each direction of strong scaling
    lines = ["Weak scaling with one block of cells for each process of 8 threads:", "",
             "| space × velocity | cells of a block | MB of a field | " + " | ".join(f"{c:,} cores" for c in cores) + " | 100,000, compact |",
             "|---|---|---|" + "---|" * (len(cores) + 1)]
    gases = [gas_of(entry) for entry in measured["data"]["gases"] if entry["dimensions"] > 1]
    for gas in gases:
        for side in sides[gas.dimensions]:
            size = side ** gas.dimensions * gas.numbers * 8e-6
            cells = " × ".join([str(side)] * gas.dimensions)
            values = " | ".join(f"{100 * efficiency(gas, network, side, c, 8):.0f} %" for c in cores)
            compact = f"{100 * efficiency(gas, network, side, cores[-1], 8, compact=True):.0f} %"
            lines.append(f"| {gas.name} | {cells} | {size:.0f} | {values} | {compact} |")
    lines += ["", "Strong scaling of one mesh:", "", "| space × velocity | mesh | " + " | ".join(f"{c:,} cores" for c in cores) + " |",
              "|---|---|" + "---|" * len(cores)]
    for gas in gases:
        n, d = totals[gas.dimensions], gas.dimensions
        values = []
        for c in cores:
            side = n / (c / 8) ** (1.0 / d)
            parts = seconds_of_step(gas, network, side, c, 8)
            values.append(f"{100 * parts[0] / sum(parts):.0f} %, {sum(parts):.2g} s")
        lines.append(f"| {gas.name} | {' × '.join([f'{n:,}'] * d)} | " + " | ".join(values) + " |")
    return "\n".join(lines)
