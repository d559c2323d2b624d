"""Python can call the C interface by ctypes, and its two descriptions, apsis.h and the Fortran module apsis.f90, agree.

Usage: APSIS_C_LIBRARY=libapsis_c.so test_ctypes.py
"""
import ctypes
import math
import os
import re
import threading
import unittest
from ctypes import CFUNCTYPE, POINTER, byref, c_char_p, c_double, c_int, c_longlong, c_size_t, c_void_p
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEADER = (ROOT / "src/apsis/apsis.h").read_text(encoding="utf-8")
MODULE = (ROOT / "src/apsis/apsis.f90").read_text(encoding="utf-8")

NUMBERS = POINTER(c_double)
TRANSPORT = CFUNCTYPE(c_int, c_double, c_size_t, NUMBERS, NUMBERS, c_void_p)
STAGE = CFUNCTYPE(c_int, c_double, c_double, c_double, c_size_t, NUMBERS, c_void_p)

apsis = ctypes.CDLL(os.environ["APSIS_C_LIBRARY"])
apsis.apsis_error_message.restype = c_char_p
apsis.apsis_find_method.argtypes = [c_char_p, POINTER(c_void_p)]
apsis.apsis_free_method.argtypes = [c_void_p]
apsis.apsis_new_integrator.argtypes = [c_void_p, c_size_t, POINTER(c_void_p)]
apsis.apsis_free_integrator.argtypes = [c_void_p]
apsis.apsis_set_transport.argtypes = [c_void_p, TRANSPORT]
apsis.apsis_set_stage.argtypes = [c_void_p, STAGE]
apsis.apsis_set_step.argtypes = [c_void_p, c_double]
apsis.apsis_set_first_step.argtypes = [c_void_p, c_double]
apsis.apsis_set_tolerance.argtypes = [c_void_p, c_double, c_double]
apsis.apsis_start.argtypes = [c_void_p, c_double, NUMBERS]
apsis.apsis_integrate.argtypes = [c_void_p, c_double]
apsis.apsis_state.argtypes = [c_void_p]
apsis.apsis_state.restype = NUMBERS
apsis.apsis_count.argtypes = [c_void_p, c_int]
apsis.apsis_count.restype = c_longlong
apsis.apsis_relaxation_weights.argtypes = [c_double, c_double, c_double, NUMBERS, NUMBERS]
apsis.apsis_relaxation_weights.restype = None

OK, NUMERICAL_ERROR, INPUT_ERROR, CALLBACK_ERROR = 0, -2, -1, -5


def message():
    return apsis.apsis_error_message().decode()


class Integrator:
    """Integrates u1' = u2, u2' = (1 + u1²)(sin u1 − u2)/ε with u(0) = (2, 0) in equal steps."""

    def __init__(self, method, epsilon, steps, transport=None):
        def default_transport(t, n, u, out, data):
            out[0], out[1] = u[1], 0.0
            return 0

        def stage(t, a, b, n, u, data):
            of_u, of_e = c_double(), c_double()
            apsis.apsis_relaxation_weights(a, b, (1 + u[0]**2) / epsilon, byref(of_u), byref(of_e))
            u[1] = of_u.value * u[1] + of_e.value * math.sin(u[0])
            return 0

        self.callbacks = TRANSPORT(transport or default_transport), STAGE(stage)  # keeps the callbacks alive
        found, self.handle = c_void_p(), c_void_p()
        assert apsis.apsis_find_method(method.encode(), byref(found)) == OK, message()
        assert apsis.apsis_new_integrator(found, 2, byref(self.handle)) == OK, message()
        apsis.apsis_free_method(found)
        apsis.apsis_set_transport(self.handle, self.callbacks[0])
        apsis.apsis_set_stage(self.handle, self.callbacks[1])
        apsis.apsis_set_step(self.handle, 1.0 / steps)
        assert apsis.apsis_start(self.handle, 0.0, (c_double * 2)(2.0, 0.0)) == OK, message()

    def __del__(self):
        apsis.apsis_free_integrator(self.handle)

    def integrate(self, t1=1.0):
        return apsis.apsis_integrate(self.handle, t1)

    def state(self):
        return tuple(apsis.apsis_state(self.handle)[:2])


def solution(method, epsilon, steps):
    one = Integrator(method, epsilon, steps)
    assert one.integrate() == OK, message()
    return one.state()


def distance(u, v):
    return sum(abs(a - b) for a, b in zip(u, v))


class FromPython(unittest.TestCase):
    def test_solves_the_model_of_the_paper(self):
        # examples/quickstart.cpp prints these digits.
        self.assertLess(distance(solution("md-imex-6-3", 1e-8, 64), (2.677671, 0.447459)), 1e-6)

    def test_converges_with_the_order_of_the_method(self):
        for method, order in (("md-imex-3-2", 2), ("md-imex-6-3", 3)):
            reference = solution(method, 1.0, 1024)  # has at most 1/64 of the errors below
            errors = [distance(solution(method, 1.0, steps), reference) for steps in (64, 128)]
            self.assertAlmostEqual(math.log2(errors[0] / errors[1]), order, delta=0.2, msg=method)

    def test_reports_errors(self):
        none = c_void_p()
        self.assertEqual(apsis.apsis_find_method(b"md-imex-6-33", byref(none)), INPUT_ERROR)
        self.assertIn("did you mean 'md-imex-6-3'?", message())

        def fails(t, n, u, out, data):
            out[0], out[1] = u[1], 0.0
            return -4 if t > 0.5 else 0

        one = Integrator("md-imex-6-3", 0.1, 64, fails)
        self.assertEqual(one.integrate(), CALLBACK_ERROR)
        self.assertIn("the callback 'transport' failed (it returned -4)", message())

        def gives_nan(t, n, u, out, data):
            out[0], out[1] = math.nan, 0.0
            return 0

        self.assertEqual(Integrator("md-imex-6-3", 0.1, 64, gives_nan).integrate(), NUMERICAL_ERROR)
        self.assertIn("the result of the callback 'transport' is not finite (component 0)", message())

    def test_begins_with_the_given_step(self):
        def steps(first):
            one = Integrator("md-imex-6-3", 1.0, 64)
            self.assertEqual(apsis.apsis_set_step(one.handle, 0.0), OK)
            self.assertEqual(apsis.apsis_set_tolerance(one.handle, 0.0, 1e-3), OK)
            self.assertEqual(apsis.apsis_set_first_step(one.handle, first), OK)
            self.assertEqual(one.integrate(2.0**-10), OK)
            return apsis.apsis_count(one.handle, 0)

        # Without a first step, one step suffices. Steps grow by factors of 2 at most: 2**-20 + … + 2**-11 < 2**-10.
        self.assertEqual(steps(0.0), 1)
        self.assertGreater(steps(2.0**-20), 10)
        one = Integrator("md-imex-6-3", 1.0, 64)
        self.assertEqual(apsis.apsis_set_first_step(one.handle, -1.0), INPUT_ERROR)
        self.assertIn("the first step is -1", message())

    def test_two_threads_have_the_results_of_one(self):
        expected = [solution("md-imex-6-3", 0.1, 256), solution("md-imex-3-2", 1e-4, 256)]
        found = [None, None]

        def run(k, *arguments):
            found[k] = solution(*arguments)

        threads = [threading.Thread(target=run, args=(0, "md-imex-6-3", 0.1, 256)),
                   threading.Thread(target=run, args=(1, "md-imex-3-2", 1e-4, 256))]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        self.assertEqual(found, expected)


class Descriptions(unittest.TestCase):
    functions = set(re.findall(r"^(?!typedef)[\w* ]+?\b(apsis_\w+)\(", HEADER, re.M))

    def test_the_library_has_every_function_of_the_header(self):
        self.assertGreater(len(self.functions), 40)
        self.assertEqual([name for name in sorted(self.functions) if not hasattr(apsis, name)], [])

    def test_the_fortran_module_has_the_functions_and_constants_of_the_header(self):
        self.assertEqual(set(re.findall(r"^    (?:[\w()]+ )*(?:function|subroutine) (apsis_\w+)\(.*bind\(c\)", MODULE, re.M))
                         - set(self.callbacks(MODULE, r"function (apsis_\w+_function)\(")), self.functions)
        self.assertEqual(set(self.callbacks(MODULE, r"function (apsis_\w+_function)\(")),
                         set(self.callbacks(HEADER, r"^typedef int (apsis_\w+_function)\(")))
        constants = dict(re.findall(r"^  (APSIS_\w+) = (-?[0-9]+)", HEADER, re.M))
        self.assertGreater(len(constants), 20)
        in_module = dict(re.findall(r"\b(APSIS_[A-Z_]+) = (-?[0-9]+)", MODULE))
        self.assertEqual(in_module.pop("APSIS_MODULE_ABI_VERSION"), re.search(r"#define APSIS_ABI_VERSION (\d+)", HEADER)[1])
        self.assertEqual(in_module, constants)

    @staticmethod
    def callbacks(text, pattern):
        return re.findall(pattern, text, re.M)


if __name__ == "__main__":
    unittest.main()
