"""A case has the same results, bit for bit, on any number of processes and threads, and after restarts on other numbers of them
(docs/processes.md, docs/device.md)."""
import json
import unittest

from processes import Folder, main, one_of, slow

# A gas with a force around two solid boxes. Its boundaries are of many kinds: moving, with a given temperature, adiabatic,
# radiating, open. Near two corners the density is so small that the limiter acts there.
STEP = """
title = "Gas around boxes"
[model]
name = "bgk"
epsilon = "0.02 + 0.1*x"
degrees_of_freedom = 3
[initial]
rho = "(x - 0.7)*(y - 0.6) > 0.05 ? 1e-9 : 1 + 0.2*sin(2*pi*x)*cos(pi*y)"
u = [0.1, "0.05*cos(2*pi*x)"]
T = "1 + 0.1*y"
[space]
limiter = "positivity"
cells = [15, 13]
domain = [[0, 1.5], [0, 1.3]]
boundary = "diffuse"
[boundary.top]
kind = "diffuse"
velocity = ["0.2*sin(40*t)", 0]
T = "1.1 + 0.1*x"
[boundary.left]
kind = "vacuum"
[boundary.right]
kind = "mass-flow"
flux = "table(t, 0, -0.05, 0.01, 0.1, 0.02, -0.02)*y"
[boundary.bottom]
kind = "symmetry"
[[space.solid]]
name = "box"
from = [0.3, 0.2]
to = [0.5, 0.6]
kind = "radiating"
sigma = 0.3
surroundings = 0.8
[[space.solid]]
name = "corner"
from = [1.2, 0.0]
to = [1.5, 0.4]
kind = "adiabatic"
accommodation = 0.7
[force]
acceleration = ["0.1*cos(y)", 0]
[velocity]
max = 7.5
points = 12
[time]
method = "md-imex-6-3"
end = 0.02
safety = 1
[output]
every = 0.01
fields = ["rho", "u_x", "u_y", "T", "heat_flux_x", "stress_xy"]
distribution = "snapshots"
stride = 4
surfaces = ["all"]
[[output.probe]]
name = "line"
from = [0.05, 0.7]
to = [1.45, 1.2]
points = 7
[[output.slice]]
name = "cut"
normal = "y"
at = 1.0
"""

# Bodies that overlap, and that touch the solid boxes and the faces of the domain. Small cells join others across borders of blocks.
BODIES = STEP.replace("[force]", '''[[space.body]]
name = "disc"
shape = "circle"
centre = [0.86, 0.61]
radius = 0.23
kind = "adiabatic"
accommodation = 0.6
velocity = ["0.61 - y", "x - 0.86"]
[[space.body]]
name = "wedge"
shape = "polygon"
points = [[0.6, 0.7], [1.01, 0.63], [0.83, 1.1]]
kind = "symmetry"
[[space.body]]
name = "floor"
shape = "half_space"
point = [0, 0.14]
normal = [0.1, 1]
T = 0.9
[force]''').replace('"bgk"', '"shakhov"').replace('flux = "table(t, 0, -0.05, 0.01, 0.1, 0.02, -0.02)*y"', 'total_flow = "table(t, 0, -0.05, 0.01, 0.1, 0.02, -0.02)"')

ABOUT_AN_AXIS = """
title = "A ball that turns about the axis of a stream"
[model]
name = "shakhov"
tails = "nonnegative"
epsilon = 0.1
[initial]
rho = "1 + 0.2*sin(pi*x)*y"
u = [1, 0, 0]
T = 1
[space]
geometry = "axisymmetric"
cells = [12, 8]
domain = [[-1, 1], [0, 1.2]]
boundary = "outflow"
[boundary.left]
kind = "mass-flow"
total_flow = 4.4
[boundary.top]
kind = "adiabatic"
[[space.body]]
name = "ball"
shape = "circle"
centre = [0.1, 0]
radius = 0.6
T = 1.2
velocity = [0, 0, "0.3*y"]
[velocity]
max = 6
points = 8
rings = 6
angles = 12
[time]
method = "md-imex-3-2"
end = 0.02
safety = 1
[output]
surfaces = ["ball"]
"""

IN_SPACE = """
title = "A ball in space"
[model]
name = "es-bgk"
epsilon = 0.1
[initial]
rho = "1 + 0.2*sin(pi*x)"
u = [1, 0.2, 0]
T = 1
[space]
limiter = "positivity"
cells = [9, 8, 8]
domain = [[-1, 1], [-1, 1], [-1, 1]]
boundary = "outflow"
[[space.body]]
name = "ball"
shape = "sphere"
centre = [0.1, 0.05, 0]
radius = 0.6
T = 1.2
[velocity]
max = 6
points = 8
[time]
method = "md-imex-3-2"
end = 0.05
safety = 1
[output]
surfaces = ["ball"]
"""

PERIODIC = """
title = "Waves in a periodic box"
[model]
name = "bgk"
epsilon = 0.01
[initial]
rho = "1 + 0.2*sin(2*pi*(x + y - z))"
u = ["0.1*cos(2*pi*y)", 0, 0.1]
T = 1
[space]
cells = [8, 7, 9]
[velocity]
max = 6
points = 8
[time]
method = "md-imex-3-2"
end = 0.01
cfl = 0.4
"""

# Two jets collide and heat the gas, so that its distribution reaches beyond the velocity grid.
JETS = """
title = "Jets"
[model]
name = "bgk"
epsilon = 0.1
[initial]
rho = 1
u = "x > 0.5 ? -3 : 3"
T = 0.1
[space]
cells = 24
boundary = "outflow"
limiter = "positivity"
[velocity]
max = 11
points = 110
[time]
method = "md-imex-6-3"
end = 0.05
safety = 1
"""


class SameResults(Folder):
    def expect_same(self, case, *overrides, counts=(2, 3, 4), threads=(1, 1, 2)):
        self.completed(1, "run", case, *overrides, "--out", "one")
        for count, of_each in zip(counts, threads):
            self.completed(count, "run", case, *overrides, "--out", f"on-{count}", threads=of_each)
            self.assert_same_results("one", f"on-{count}")

    def test_walls_boxes_and_a_force_in_the_plane(self):
        self.write("step.toml", STEP)
        self.expect_same("step.toml")

    def test_a_device_for_each_process(self):
        self.write("step.toml", STEP)
        self.completed(1, "run", "step.toml", "--out", "one")
        for count in one_of((3, 2, 4), 0):
            self.completed(count, "run", "step.toml", "--device", "teams", "--out", f"on-{count}")
            self.assert_same_results("one", f"on-{count}")
        self.completed(2, "run", "step.toml", "time.end=0.01", "--device", "teams", "--out", "half")
        self.completed(3, "run", "step.toml", "--restart", "half/checkpoint.h5", "--out", "rest")
        for name in ("fields.csv", "history.csv"):
            self.assertEqual((self.folder / "one" / name).read_text(), (self.folder / "rest" / name).read_text())

    def test_bodies_in_the_plane_across_all_borders(self):
        self.write("bodies.toml", BODIES)
        self.expect_same("bodies.toml", counts=one_of((5, 3, 2), 0))
        self.completed(2, "run", "bodies.toml", "--device", "teams", "--out", "on-devices")
        self.assert_same_results("one", "on-devices")
        self.completed(3, "run", "bodies.toml", "time.end=0.01", "--out", "half")
        self.completed(2, "run", "bodies.toml", "--restart", "half/checkpoint.h5", "--out", "rest")
        for name in ("fields.csv", "history.csv", "surfaces/disc.csv", "surfaces/wedge.csv"):
            self.assertEqual((self.folder / "one" / name).read_text(), (self.folder / "rest" / name).read_text())

    @slow
    def test_bodies_in_blocks_of_two_cells(self):
        # In such narrow blocks a process needs rows of cells beyond those of its neighbours.
        self.write("bodies.toml", BODIES)
        self.completed(1, "run", "bodies.toml", "--out", "one")
        for count, blocks in ((7, "[7,1]"), (6, "[1,6]"), (9, "[3,3]")):
            self.completed(count, "run", "bodies.toml", f"space.blocks={blocks}", "--out", f"on-{count}")
            self.assert_same_results("one", f"on-{count}")

    def test_a_body_in_space(self):
        self.write("ball.toml", IN_SPACE)
        self.expect_same("ball.toml", counts=one_of((5, 2, 3, 8), 0))

    def test_axisymmetric_flow(self):
        self.write("axis.toml", ABOUT_AN_AXIS)
        self.expect_same("axis.toml", counts=one_of((5, 2, 3), 0))

    @slow
    def test_blocks_of_a_chosen_shape(self):
        self.write("step.toml", STEP)
        self.completed(1, "run", "step.toml", "--out", "one")
        for count, blocks in ((3, "[1,3]"), (4, "[4,1]"), (6, "[2,3]")):
            self.completed(count, "run", "step.toml", f"space.blocks={blocks}", "--out", f"on-{count}")
            self.assert_same_results("one", f"on-{count}")

    def test_of_velocities_that_end_too_early(self):
        self.write("jets.toml", JETS)
        self.expect_same("jets.toml", counts=(3,))
        numbers = [{name: value for name, value in json.loads((self.folder / folder / "manifest.json").read_text())["result"].items()
                    if name.startswith("velocity_")} for folder in ("one", "on-3")]
        self.assertEqual(*numbers)
        self.assertGreater(numbers[0]["velocity_missed"], 1e-3)
        ends = [self.run_on(count, "run", "jets.toml", "velocity.max=5", "velocity.points=50") for count in (1, 3)]
        for end in ends:
            self.assertEqual(end.returncode, 3, end.stderr)
        said = [[line for line in end.stderr.splitlines() if "velocity.max = 5 is too small" in line] for end in ends]
        self.assertEqual(*said)
        self.assertIn(len(said[0]), (1, 2))  # the error, and before it at most one warning

    @slow
    def test_a_periodic_box_in_space(self):
        self.write("periodic.toml", PERIODIC)
        self.expect_same("periodic.toml")

    def test_cell_averages_on_a_line(self):
        self.expect_same("paper/bgk-mixed", "space.cells=37", "velocity.points=60", "time.end=0.02", counts=(3,))

    def test_collisions_at_centres(self):
        self.expect_same("paper/bgk-mixed", "space.cells=23", "space.collisions=centres", "velocity.points=40", "time.end=0.02", counts=(3,))
        self.expect_same("gas/couette", "space.cells=8", "space.formulation=finite-volume", "space.collisions=centres", "velocity.points=[12,8]",
                         "time.end=0.05", counts=(4,))

    @slow
    def test_collisions_at_centres_of_one_cell_for_each_process(self):
        self.expect_same("gas/couette", "space.cells=9", "space.formulation=finite-volume", "space.collisions=centres", "velocity.points=[12,8]",
                         "time.end=0.02", counts=(9,))

    def test_a_line_whose_middle_process_has_no_wall(self):
        self.expect_same("gas/couette", "space.cells=12", "velocity.points=[12,8]", "time.end=0.05", 'output.surfaces="all"', counts=(3,))

    def test_the_measured_cut_of_a_target(self):
        self.expect_same("gas/shock", "model.name=shakhov", "model.tails=nonnegative", "space.cells=30", "time.end=1", counts=(3,))
        self.assertGreater(json.loads((self.folder / "one/manifest.json").read_text(encoding="utf-8"))["result"]["largest_cut"], 1e-3)

    def test_steps_to_a_tolerance(self):
        self.expect_same("paper/bgk-mixed", "space.cells=24", "velocity.points=40", "time.end=0.05", "time.method=md-imex-8-3-mixed",
                         "time.tolerance=1e-4", "time.startup=graded", "time.controller=pid", counts=(3,))

    def test_doubled_steps_to_a_tolerance(self):
        self.expect_same("paper/bgk-mixed", "space.cells=24", "velocity.points=40", "time.end=0.02", "time.method=ars-443",
                         "time.tolerance=1e-4", counts=(3,))

    def test_multistep_and_exponential_methods_and_their_restarts(self):
        self.write("step.toml", STEP.replace("safety = 1", "dt = 0.0005").replace("every = 0.01", "every = 0.005"))
        for method in ("imex-bdf-3", "imex-dimsim-3", "two-step-8-3-narrow", "exponential-2"):
            out = f"{method}-"
            chosen = ("step.toml", f"time.method={method}", "space.cells=[15,13]")
            self.completed(1, "run", *chosen, "--out", out + "one")
            self.completed(3, "run", *chosen, "--out", out + "three")
            self.assert_same_results(out + "one", out + "three")
            self.completed(4, "run", *chosen, "time.end=0.012", "--out", out + "part")
            self.completed(2, "run", *chosen, "--restart", out + "part/checkpoint.h5", "--out", out + "rest")
            for name in ("fields.csv", "history.csv"):
                self.assertEqual((self.folder / (out + "one") / name).read_text(), (self.folder / (out + "rest") / name).read_text())
            self.assert_same_datasets(self.folder / (out + "one") / "solution.h5", self.folder / (out + "rest") / "solution.h5")

    @slow
    def test_a_steady_state(self):
        self.expect_same("gas/couette", "space.cells=12", "velocity.points=[16,12]", "time.steady=1e-3", "time.end=2", counts=(2,))

    @slow
    def test_a_general_model_and_a_conservation_law(self):
        self.expect_same("benchmarks/nine-velocities", "space.cells=[11,9]", "time.end=0.1", counts=(3,))
        self.folder = self.folder / "law"
        self.folder.mkdir()
        self.expect_same("laws/circular-dam", "space.cells=[17,13]", "time.end=0.1", counts=(4,))

    @slow
    def test_one_cell_for_each_process(self):
        self.expect_same("paper/bgk-mixed-fd", "space.cells=9", "velocity.points=40", "time.end=0.02", counts=(9,))

    def test_restarts_on_other_numbers_of_processes(self):
        self.write("step.toml", STEP)
        self.completed(1, "run", "step.toml", "--out", "whole")
        for number, (count, end) in enumerate(((1, 0.007), (7, 0.013), (3, 0.02))):
            restart = ("--restart", f"part-{number - 1}/checkpoint.h5") if number else ()
            self.completed(count, "run", "step.toml", f"time.end={end}", *restart, "--out", f"part-{number}")
        for name in ("fields.csv", "history.csv"):
            self.assertEqual((self.folder / "whole" / name).read_text(), (self.folder / "part-2" / name).read_text())
        self.assert_same_datasets(self.folder / "whole" / "solution.h5", self.folder / "part-2" / "solution.h5")


if __name__ == "__main__":
    main()
