"""Recipe of Spack 1.0 or later, see packaging/README.md. It fetches the repository that contains this file."""
import os
import pathlib

from spack_repo.builtin.build_systems.cmake import CMakePackage, generator
from spack_repo.builtin.build_systems.python import PythonExtension, PythonPipBuilder

from spack.package import *


class Apsis(CMakePackage, PythonExtension):
    """SSP multi-derivative IMEX Runge-Kutta methods for stiff relaxation and kinetic equations."""

    git = f"file://{pathlib.PurePath(__file__).parents[4]}"

    license("BSD-3-Clause")

    version("main", branch="main")

    variant("python", default=True, description="Install the Python package")
    variant("mpi", default=True, description="Share the cells of a run among processes")
    variant("design", default=True, description="Search for methods with Ipopt")

    generator("ninja")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("fmt")
    depends_on("tomlplusplus")
    depends_on("nlohmann-json")
    depends_on("eigen")
    depends_on("boost@1.74:+context")
    depends_on("muparser")
    depends_on("hdf5~mpi")
    depends_on("xxhash@0.8:")
    depends_on("cli11")
    depends_on("highway")
    depends_on("mpi", when="+mpi")
    depends_on("ipopt", when="+design")

    extends("python", when="+python")
    with when("+python"):
        depends_on("python@3.11:", type=("build", "link", "run"))
        depends_on("py-setuptools@66:", type="build")
        depends_on("py-pip", type="build")
        depends_on("py-wheel", type="build")
        depends_on("py-pybind11", type=("build", "link"))
        depends_on("py-numpy", type=("build", "run"))
        depends_on("py-matplotlib", type="run")
        depends_on("py-h5py", type="run")

    def cmake_args(self):
        components = ["integrate", "kinetic", "c"]
        if self.spec.satisfies("+design"):
            components.append("design")
        args = [
            self.define("APSIS_COMPONENTS", components),
            self.define("APSIS_TESTS", False),
            self.define("APSIS_WERROR", False),
            self.define_from_variant("APSIS_MPI", "mpi"),
            self.define_from_variant("APSIS_PYTHON_PACKAGE", "python"),
        ]
        if self.spec.satisfies("+python"):
            args.append(self.define("Python3_EXECUTABLE", self.spec["python"].command.path))
        return args

    @run_after("install")
    def install_python(self):
        if self.spec.satisfies("+python"):
            os.environ["APSIS_BUILD_DIR"] = self.build_directory  # read by setup.py
            with working_dir(self.stage.source_path):
                pip(*PythonPipBuilder.std_args(self), f"--prefix={self.prefix}", ".")
