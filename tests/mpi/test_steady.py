"""Several processes find the same steady state as one process, up to the tolerance (docs/steady.md)."""
import csv
import unittest

import numpy as np

from processes import Folder, main

CAVITY = ("gas/cavity", "space.cells=[13,11]", "velocity.points=12", "steady.tolerance=1e-9")
# A force drives the gas along a periodic channel, around a warm box.
CHANNEL = """
title = "Flow around a box"
[model]
name = "shakhov"
epsilon = "0.3 + 0.1*y"
degrees_of_freedom = 3
[space]
cells = [18, 9]
domain = [[0, 2], [0, 1]]
[boundary.bottom]
kind = "diffuse"
[boundary.top]
kind = "diffuse"
velocity = [0.1, 0]
[[space.solid]]
from = [0.6666666666666666, 0.3333333333333333]
to = [1.1111111111111112, 0.6666666666666666]
T = 1.2
[force]
acceleration = [0.05, 0]
[initial]
rho = 1
T = 1
[velocity]
max = 6
points = 10
[steady]
tolerance = 1e-9
"""
# Half of a cylinder in a supersonic stream. Borders of blocks pass through its groups of cut cells.
CYLINDER = ("gas/cylinder", "parameters.Kn=0.5", "space.cells=[36,18]", "velocity.points=12", "steady.tolerance=1e-9",
            'output.surfaces=["cylinder"]')
# An iterate differs from the steady state by the tolerance (1e-9) times the number of iterations in which an error decays (about
# ten). The bound has a margin of ten.
CLOSE = 1e-7


class SteadyStates(Folder):
    def fields(self, folder):
        with open(self.folder / folder / "fields.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}

    def last(self, folder):
        """Returns the last row of the history."""
        with open(self.folder / folder / "history.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))[-1]

    def iterations(self, folder):
        return int(self.last(folder)["step"])

    def found(self, count, *case, out):
        self.completed(count, "run", *case, "--out", out)
        return self.iterations(out)

    def assert_close(self, a, b):
        mine, others = self.fields(a), self.fields(b)
        self.assertEqual(mine.keys(), others.keys())
        for name, values in mine.items():
            self.assertTrue(np.allclose(values, others[name], rtol=0, atol=CLOSE * max(1.0, np.nanmax(np.abs(values))), equal_nan=True), name)

    def expect_close(self, *case, counts=(2, 3, 4), most=1.5):
        """Checks that several processes find the state of one process in fewer than `most` times its iterations.

        They need more iterations, since molecules in free flight cross one block in an iteration.
        """
        alone = self.found(1, *case, out="one")
        for count in counts:
            self.assertLess(self.found(count, *case, out=f"on-{count}"), most * alone, count)
            self.assert_close("one", f"on-{count}")

    def test_a_cavity_with_walls_on_every_process(self):
        self.expect_close(*CAVITY, "parameters.delta=10")

    def test_processes_without_a_wall(self):
        self.expect_close("gas/couette", "space.cells=12", "velocity.points=[12,8]", "steady.tolerance=1e-9", counts=(3,), most=3)

    def test_a_periodic_channel_around_a_box(self):
        self.write("channel.toml", CHANNEL)
        self.expect_close("channel.toml", counts=(2, 5))

    def test_a_nonnegative_state_between_cold_and_hot_plates(self):
        # The solver removes negative values of the size of the tolerance. Here they are on several processes.
        self.expect_close("gas/fourier", "parameters.delta=10", "boundary.left.T=9", "velocity.max=18", "velocity.points=48",
                          "model.name=es-bgk", "space.cells=24", "space.limiter=positivity", "steady.tolerance=1e-9", counts=(2, 3), most=6)
        for folder in ("one", "on-2", "on-3"):
            self.assertGreaterEqual(float(self.last(folder)["min_value"]), 0)

    def assert_equal_loads(self, a, b):
        mine, others = self.last(a), self.last(b)
        for name in ("C_D_cylinder", "flux_cylinder_momentum_y", "C_H_cylinder"):
            self.assertAlmostEqual(float(mine[name]), float(others[name]), delta=CLOSE * 10, msg=name)
        self.assertGreater(float(mine["C_D_cylinder"]), 1)

    def test_a_flow_past_a_cylinder(self):
        self.expect_close(*CYLINDER)
        for count in (2, 3, 4):
            self.assert_equal_loads("one", f"on-{count}")

    def test_a_flow_past_a_cylinder_is_restarted_on_fewer_processes(self):
        self.found(1, *CYLINDER, out="one")
        self.completed(3, "run", *CYLINDER, "steady.tolerance=1e-3", "--out", "coarse")
        self.completed(2, "run", *CYLINDER, "--restart", "coarse/checkpoint.h5", "--out", "rest")
        self.assert_close("one", "rest")
        self.assert_equal_loads("one", "rest")

    def test_a_restart_on_another_number_of_processes(self):
        self.found(1, *CAVITY, out="one")
        self.completed(2, "run", *CAVITY, "steady.tolerance=1e-3", "--out", "coarse")
        self.completed(3, "run", *CAVITY, "--restart", "coarse/checkpoint.h5", "--out", "rest")
        self.assert_close("one", "rest")

    def test_an_error_of_one_process_ends_all(self):
        done = self.run_on(3, "run", *CAVITY, "steady.iterations=3", "--out", "three")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertEqual(done.stderr.count("no steady state in 3 iterations"), 1, done.stderr)


if __name__ == "__main__":
    main()
