"""The libraries of the C interfaces export the functions of their exported.map, which are those of their headers.

A list of names in exported.map is the binary interface that later versions preserve (docs/linking.md). The linker reads it, too.

Usage: APSIS_NM=nm APSIS_LIBRARY=libapsis_c.so APSIS_MAP=src/apsis/c/exported.map APSIS_HEADER=src/apsis/apsis.h test_exports.py
"""
import os
import re
import subprocess
import unittest
from pathlib import Path


def declared_in(header):
    """Returns the functions that a header declares."""
    return set(re.findall(r"^(?!typedef\b|static\b)[A-Za-z_][\w* ]*?\b(\w+)\(", header, re.M))


def version_of(header):
    """Returns the name of the version that belongs to the binary interface of a header, such as APSIS_1."""
    name, number = re.search(r"^#define (\w+)_ABI_VERSION (\d+)$", header, re.M).groups()
    return f"{name}_{number}"


def listed_in(text):
    """Returns version, names and optional names of an exported.map in the order of its lines; a star marks optional names."""
    version, body = re.search(r"^(\w+) \{\n  global:\n(.*?)  local: \*;\n\};\n$", text, re.M | re.S).groups()
    names = re.findall(r"^    (\S+);$", body, re.M)
    if len(names) != body.count("\n"):
        raise ValueError("exported.map has a line that is not the name of one function")
    return version, [name.rstrip("*") for name in names], {name[:-1] for name in names if name.endswith("*")}


def exported_by(table):
    """Returns the names in the output of nm -D --defined-only, without versions of symbols, which nm lists as absolute."""
    symbols = [line.split() for line in table.splitlines()]
    return {name.partition("@")[0] for *_, kind, name in symbols if kind != "A"}


def problems(header, text, table):
    """Returns what differs between a header, an exported.map and an output of nm; one line for each function."""
    version, names, optional = listed_in(text)
    listed, declared, exported = set(names), declared_in(header), exported_by(table)
    found = [f"{name} is listed in exported.map, and the library does not export it" for name in sorted(listed - optional - exported)]
    found += [f"{name} is exported by the library, and not listed in exported.map" for name in sorted(exported - listed)]
    found += [f"{name} is declared in the header, and not listed in exported.map" for name in sorted(declared - listed)]
    found += [f"{name} is listed in exported.map, and not declared in the header" for name in sorted(listed - declared)]
    if names != sorted(listed):
        found.append("the names in exported.map are not sorted, or occur twice")
    if version != version_of(header):
        found.append(f"exported.map has the version {version}, and the header {version_of(header)}")
    return found


class Planted(unittest.TestCase):
    header = "#define MINE_ABI_VERSION 2\ntypedef int my_callback(int);\nint my_first(int a,\n             int b);\nconst char* my_second(void);\n"
    text = "/* A comment. */\nMINE_2 {\n  global:\n    my_first;\n    my_second;\n  local: *;\n};\n"
    table = "0000000000000000 A MINE_2\n0000000000001000 T my_first@@MINE_2\n0000000000002000 T my_second@@MINE_2\n"

    def test_equal_lists_have_no_problems(self):
        self.assertEqual(problems(self.header, self.text, self.table), [])

    def test_a_function_that_is_gone_is_named(self):
        table = self.table.replace("0000000000002000 T my_second@@MINE_2\n", "")
        self.assertEqual(problems(self.header, self.text, table), ["my_second is listed in exported.map, and the library does not export it"])
        header = self.header.replace("const char* my_second(void);\n", "")
        self.assertEqual(problems(header, self.text, table)[1:], ["my_second is listed in exported.map, and not declared in the header"])

    def test_a_function_without_a_line_is_named(self):
        table = self.table + "0000000000003000 T my_third@@MINE_2\n"
        self.assertEqual(problems(self.header, self.text, table), ["my_third is exported by the library, and not listed in exported.map"])
        header = self.header + "void my_third(void);\n"
        self.assertEqual(problems(header, self.text, self.table), ["my_third is declared in the header, and not listed in exported.map"])

    def test_data_of_a_library_is_an_export(self):
        table = self.table + "0000000000004000 B my_table\n"
        self.assertEqual(problems(self.header, self.text, table), ["my_table is exported by the library, and not listed in exported.map"])

    def test_an_optional_function_may_be_absent_and_nothing_else_matches_its_star(self):
        text = self.text.replace("my_second;", "my_second*;")
        table = self.table.replace("0000000000002000 T my_second@@MINE_2\n", "")
        self.assertEqual(problems(self.header, text, table), [])
        more = table + "0000000000002000 T my_second_more@@MINE_2\n"
        self.assertEqual(problems(self.header, text, more), ["my_second_more is exported by the library, and not listed in exported.map"])

    def test_a_pattern_in_place_of_names_is_no_list(self):
        text = self.text.replace("    my_first;\n    my_second;\n", "    my_*;\n")
        self.assertIn("my_first is declared in the header, and not listed in exported.map", problems(self.header, text, self.table))
        with self.assertRaises(ValueError):
            listed_in(self.text.replace("    my_second;\n", "    my_second; my_third;\n"))

    def test_order_and_version_belong_to_the_list(self):
        text = "MINE_1 {\n  global:\n    my_second;\n    my_first;\n  local: *;\n};\n"
        self.assertEqual(problems(self.header, text, self.table), ["the names in exported.map are not sorted, or occur twice",
                                                                   "exported.map has the version MINE_1, and the header MINE_2"])


class Library(unittest.TestCase):
    def test_exports_the_list_of_its_binary_interface(self):
        header, text = (Path(os.environ[name]).read_text(encoding="utf-8") for name in ("APSIS_HEADER", "APSIS_MAP"))
        table = subprocess.run([os.environ["APSIS_NM"], "-D", "--defined-only", os.environ["APSIS_LIBRARY"]], capture_output=True, text=True,
                               check=True).stdout
        self.assertGreater(len(declared_in(header)), 4)
        self.assertEqual(problems(header, text, table), [])


if __name__ == "__main__":
    unittest.main()
