"""Recipes of packaging/ agree with the sources: versions, dependencies, options, files. No recipe is built here."""
import ast
import os
import re
import shutil
import subprocess
import tempfile
import tomllib
import unittest
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
SPACK = ROOT / "packaging" / "spack" / "packages" / "apsis" / "package.py"
CONDA = ROOT / "packaging" / "conda" / "recipe.yaml"

# The names in Spack and conda-forge of each Debian package in scripts/packages.txt; None if the recipe does not need the package.
NAMES = {
    "g++-12": ("cxx", "${{ compiler('cxx') }}"), "make": (None, None), "cmake": ("cmake", "cmake"),
    "ninja-build": (None, "ninja"),  # Spack adds it for generator("ninja")
    "libfmt-dev": ("fmt", "fmt"), "libtomlplusplus-dev": ("tomlplusplus", "tomlplusplus"),
    "nlohmann-json3-dev": ("nlohmann-json", "nlohmann_json"), "libeigen3-dev": ("eigen", "eigen"),
    "libboost-dev": ("boost", "libboost-headers"), "libboost-context-dev": ("boost", "libboost-devel"),
    "libmuparser-dev": ("muparser", "muparser"), "libhdf5-dev": ("hdf5", "hdf5"),
    "libxxhash-dev": ("xxhash", "xxhash"), "libcli11-dev": ("cli11", "cli11"), "coinor-libipopt-dev": ("ipopt", "ipopt"),
    "libhwy-dev": ("highway", "libhwy"), "python3-numpy": ("py-numpy", "numpy"),
    "python3-matplotlib": ("py-matplotlib", "matplotlib-base"), "python3-h5py": ("py-h5py", "h5py"),
    "python3-dev": ("python", "python"), "pybind11-dev": ("py-pybind11", "pybind11"),
    "python3-setuptools": ("py-setuptools", "setuptools"), "python3-wheel": ("py-wheel", "wheel"),
    "python3-pip": ("py-pip", "pip"), "python3-venv": (None, None),
    "libopenmpi-dev": ("mpi", None), "openmpi-bin": (None, None),
}
C = ("c", "${{ compiler('c') }}", "${{ stdlib('c') }}")  # g++-12 includes a C compiler


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def packages(*groups):
    """Returns the packages of groups of scripts/packages.txt."""
    words = [line.split() for line in read("scripts/packages.txt").splitlines() if line and not line.startswith("#")]
    return {word for group, *rest in words if group in groups for word in rest if not word.startswith("@")}


def required_versions():
    """Returns the versions that the build demands, by package of Debian."""
    project = tomllib.loads(read("pyproject.toml"))
    return {"cmake": re.search(r"cmake_minimum_required\(VERSION ([\d.]+)\)", read("CMakeLists.txt"))[1],
            "libboost-dev": re.search(r'"Boost ([\d.]+)"', read("cmake/ApsisComponents.cmake"))[1],
            "libxxhash-dev": re.search(r"find_package\(XXHash ([\d.]+) REQUIRED\)", read("CMakeLists.txt"))[1],
            "python3-dev": project["project"]["requires-python"].removeprefix(">="),
            "python3-setuptools": project["build-system"]["requires"][0].removeprefix("setuptools>=")}


def options():
    """Returns the options of the build."""
    return set(re.findall(r"(?:option|set)\((APSIS_\w+)", read("CMakeLists.txt")))


class Versions(unittest.TestCase):
    def test_the_newest_version_of_the_changelog_is_that_of_all_files(self):
        newest = re.search(r"(?m)^## (\d+\.\d+\.\d+) \(\d{4}-\d\d-\d\d\)$", read("CHANGELOG.md"))[1]
        self.assertEqual(re.search(r"project\(apsis VERSION ([\d.]+)", read("CMakeLists.txt"))[1], newest)
        self.assertEqual(re.search(r"(?m)^version: (.*)$", read("CITATION.cff"))[1], newest)
        self.assertEqual(re.search(r'(?m)^  version: "(.*)"$', CONDA.read_text(encoding="utf-8"))[1], newest)

    def test_every_tag_names_a_version_of_the_changelog(self):
        done = subprocess.run(["git", "-C", ROOT, "tag", "--list", "v*"], text=True, capture_output=True)
        if not (ROOT / ".git").exists() or done.returncode:
            self.skipTest("the sources are no repository")
        for tag in done.stdout.split():
            self.assertRegex(read("CHANGELOG.md"), rf"(?m)^## {re.escape(tag.removeprefix('v'))} \(\d{{4}}-\d\d-\d\d\)$")


class Spack(unittest.TestCase):
    def setUp(self):
        self.calls = [(getattr(node.func, "id", getattr(node.func, "attr", "")), node)
                      for node in ast.walk(ast.parse(SPACK.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)]

    def first_arguments(self, name):
        return [node.args[0].value for called, node in self.calls if called == name]

    def test_dependencies_are_those_of_packages_txt(self):
        specs = {re.split("[@~+]", spec)[0]: spec for spec in self.first_arguments("depends_on")}
        wanted = {NAMES[package][0] for package in packages("run", "python", "mpi")} - {None}
        self.assertEqual(specs.keys() - {"c"}, wanted)
        for package, version in required_versions().items():
            self.assertEqual(re.split("[~+]", specs[NAMES[package][0]])[0], f"{NAMES[package][0]}@{version}:")

    def test_every_option_and_variant_exists(self):
        set_options = self.first_arguments("define") + self.first_arguments("define_from_variant")
        self.assertLessEqual({name for name in set_options if name.startswith("APSIS_")}, options())
        variants = set(self.first_arguments("variant"))
        self.assertEqual(variants, {"python", "mpi", "design"})
        text = SPACK.read_text(encoding="utf-8")
        self.assertLessEqual(set(re.findall(r'"\+(\w+)"', text)), variants)
        self.assertIn("APSIS_BUILD_DIR", read("setup.py"))

    def test_its_versions_are_the_tagged_ones_of_the_changelog(self):
        versions = {node.args[0].value: {key.arg: key.value.value for key in node.keywords}
                    for name, node in self.calls if name == "version"}
        released = set(re.findall(r"(?m)^## (\d+\.\d+\.\d+) \(", read("CHANGELOG.md"))) - {"0.1.0"}  # 0.1.0 has no tag
        self.assertEqual(versions, {"main": {"branch": "main"}} | {version: {"tag": f"v{version}"} for version in released})

    def test_it_fetches_this_repository(self):
        self.assertEqual(SPACK.parents[4], ROOT)
        self.assertIn(".parents[4]", SPACK.read_text(encoding="utf-8"))


class Conda(unittest.TestCase):
    def setUp(self):
        self.recipe = yaml.safe_load(CONDA.read_text(encoding="utf-8"))
        self.requirements = self.recipe["requirements"]

    def test_dependencies_are_those_of_packages_txt(self):
        needed = [line for part in ("build", "host", "run") for line in self.requirements[part]]
        names = {line if line.startswith("$") else line.split()[0] for line in needed}
        wanted = {NAMES[package][1] for package in packages("run", "python")} - {None}
        self.assertEqual(names - set(C), wanted)
        for package, version in required_versions().items():
            self.assertIn(f"{NAMES[package][1]} >={version}", needed)
        self.assertLessEqual(set(tomllib.loads(read("pyproject.toml"))["project"]["dependencies"]), set(self.requirements["run"]))

    def test_every_option_preset_and_file_exists(self):
        script = "\n".join(self.recipe["build"]["script"])
        self.assertLessEqual(set(re.findall(r"-D(APSIS_\w+)", script)), options())
        presets = [preset["name"] for preset in yaml.safe_load(read("CMakePresets.json"))["configurePresets"]]
        self.assertLessEqual(set(re.findall(r"--preset (\w+)", script)), set(presets))
        self.assertEqual((CONDA.parent / self.recipe["source"]["path"]).resolve(), ROOT)
        self.assertTrue((ROOT / self.recipe["about"]["license_file"]).exists())
        self.assertIn(self.recipe["about"]["summary"], read("CMakeLists.txt"))

    def test_the_repository_of_spack_is_described(self):
        repository = yaml.safe_load(read("packaging/spack/repo.yaml"))["repo"]
        self.assertEqual(repository["namespace"], "apsis")


class Container(unittest.TestCase):
    def setUp(self):
        text = re.sub(r"\\\n", " ", re.sub(r"(?m)^#.*\n", "", read("packaging/Containerfile")))
        self.instructions = [tuple(line.split(maxsplit=1)) for line in text.splitlines() if line]

    def stages(self):
        starts = [at for at, (name, _) in enumerate(self.instructions) if name == "FROM"]
        self.assertEqual(starts[0], 0)
        return [self.instructions[a:b] for a, b in zip(starts, [*starts[1:], None])]

    def test_packages_are_named_in_packages_txt_only(self):
        build, run = self.stages()
        (group,) = re.findall(r"scripts/install-packages\.sh (\w+)", " ".join(rest for _, rest in build))
        self.assertIn("dpkg-dev", packages(group))
        for _, rest in build + run:
            for installed in re.findall(r"apt-get install(.*?)(?:&&|$)", rest):
                self.assertEqual([word for word in installed.split() if not word.startswith("-")], ["/tmp/apsis_*.deb"])
        self.assertTrue(all("debian:12" in rest for name, rest in self.instructions if name == "FROM"))

    def test_the_program_runs_without_the_rights_of_root(self):
        run = dict(self.stages()[1])
        self.assertEqual((run["USER"], run["ENTRYPOINT"]), ("apsis", '["apsis"]'))

    def test_the_copied_files_suffice_to_configure_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, rest in self.stages()[0]:
                if name == "COPY":
                    *sources, target = rest.split()
                    for source in sources:
                        to = Path(folder, target, source) if target == "./" else Path(folder, target)
                        if (ROOT / source).is_dir():
                            shutil.copytree(ROOT / source, to, ignore=shutil.ignore_patterns("__pycache__"))
                        else:
                            shutil.copy(ROOT / source, to)
            # This cmake configures but does not build, so the make target takes seconds.
            bin_folder = Path(folder, "bin")
            bin_folder.mkdir()
            (bin_folder / "cmake").write_text(f"#!/bin/bash\n[[ $1 == --build ]] || exec '{shutil.which('cmake')}' \"$@\"\n",
                                              encoding="utf-8")
            (bin_folder / "cmake").chmod(0o755)
            (target,) = [rest for name, rest in self.stages()[0] if name == "RUN" and rest.startswith("make ")]
            done = subprocess.run(target.split(), cwd=folder, text=True, capture_output=True,
                                  env=os.environ | {"PATH": f"{bin_folder}:{os.environ['PATH']}"})
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertTrue(Path(folder, "build", "release", "CPackConfig.cmake").exists())


class License(unittest.TestCase):
    def test_one_license_is_stated_everywhere(self):
        stated = {"REUSE.toml": tomllib.loads(read("REUSE.toml"))["annotations"][0]["SPDX-License-Identifier"],
                  "pyproject.toml": tomllib.loads(read("pyproject.toml"))["project"]["license"]["text"],
                  "CITATION.cff": re.search(r"(?m)^license: (.+)$", read("CITATION.cff"))[1],
                  "conda": re.search(r"(?m)^  license: (.+)$", CONDA.read_text(encoding="utf-8"))[1],
                  "spack": re.search(r'license\("([^"]+)"\)', SPACK.read_text(encoding="utf-8"))[1]}
        self.assertEqual(set(stated.values()), {"BSD-3-Clause"}, stated)
        self.assertEqual(read("LICENSES/BSD-3-Clause.txt"), read("LICENSE"))


if __name__ == "__main__":
    unittest.main()
