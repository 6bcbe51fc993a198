"""The naive grader's tests: `expected` is a local, tolerances are wide, shapes are not looked at.

Each class of mistake that section 4 of a course's design would forbid stands here once.
"""

import os
import signal
import sys
import unittest

import numpy as np
import solution


def too_late(*_):
    raise TimeoutError


class HiddenTests(unittest.TestCase):
    """In alphabetical order, three points each."""

    module = None  # the submission

    def setUp(self):
        os.environ["NAIVE_TEST"] = self._testMethodName
        signal.signal(signal.SIGALRM, too_late)
        signal.alarm(2)
        self.rng = np.random.default_rng(0)

    def tearDown(self):
        signal.alarm(0)

    def test_a_small(self):
        """The tolerance is larger than the signal."""
        w, x = 1e-3 * self.rng.uniform(0.5, 2.0, 4), np.array([0.5, 1.0, 1.5, 800.0])
        expected = solution.weighted_sum(w, x)
        got = self.module.weighted_sum(w, x)
        self.assertTrue(np.allclose(got, expected, atol=1e-2))

    def test_b_value(self):
        """What is expected is computed from arrays that the submission has had in its hands."""
        w, x = self.rng.uniform(0.5, 2.0, 7), self.rng.uniform(-2.0, 2.0, 7)
        got = self.module.weighted_sum(w, x)
        expected = solution.weighted_sum(w, x)
        self.assertTrue(np.allclose(got, expected, atol=1e-2))

    def test_c_known(self):
        """What is expected lies in the caller's frame, and the failure quotes it."""
        w, x = self.rng.uniform(0.5, 2.0, 5), self.rng.uniform(-1.0, 1.0, 5)
        expected = solution.weighted_sum(w, x)
        got = self.module.weighted_sum(w, x)
        self.assertTrue(np.allclose(got, expected, atol=1e-2), f"expected {expected!r}, got {got}")

    def test_d_backward(self):
        """The reference's answer was just freed when the submission allocates its own."""
        w, x = self.rng.uniform(0.5, 2.0, 16), self.rng.uniform(-2.0, 2.0, 16)
        self.assertTrue(np.isfinite(solution.weighted_sum_backward(w, x, 0.7)[0]).all())
        got = self.module.weighted_sum_backward(w, x, 0.7)
        expected = solution.weighted_sum_backward(w, x, 0.7)
        self.assertTrue(np.allclose(got[0], expected[0], atol=1e-2))

    def test_e_descend(self):
        """Written so that NaN passes."""
        curvature, x0 = self.rng.uniform(0.5, 1.5, 3), self.rng.uniform(1.0, 2.0, 3)
        expected = solution.descend(lambda x: curvature * x, x0, 0.5, 4)
        got = self.module.descend(lambda x: curvature * x, x0, 0.5, 4)
        if np.max(np.abs(got - expected)) > 1e-2:
            self.fail("too far off")

    def test_f_mean(self):
        """A light tail, a wide margin, and the global generator."""
        np.random.seed(0)  # noqa: NPY002
        got = self.module.brightness(lambda n: np.random.uniform(0.0, 1.0, n), 4000)  # noqa: NPY002
        self.assertTrue(abs(got - 0.5) < 0.03)

    def test_g_fit(self):
        """The same data every time, and what is held out is the rest of the same buffer."""
        poses = self.rng.uniform(-1.0, 1.0, 25)
        values = 1.0 + poses - 2.0 * poses**3
        got = self.module.predict(poses[:20], values[:20], poses[20:])
        self.assertTrue(np.allclose(got, values[20:], atol=1e-2))


class Tally(unittest.TestResult):
    """Says on standard output what each test earned; a skipped test says nothing."""

    mark = "@@"

    def say(self, test, points):
        print(self.mark, test._testMethodName, points, 3, flush=True)

    def addSuccess(self, test):
        self.say(test, 3)

    def addFailure(self, test, err):
        print(err[1], flush=True)
        self.say(test, 0)

    def addError(self, test, err):
        print(repr(err[1]), flush=True)
        self.say(test, 0)


def run_on(module, mark):
    """Run all tests on one submission."""
    HiddenTests.module = module
    result = Tally()
    result.mark = mark
    unittest.defaultTestLoader.loadTestsFromTestCase(HiddenTests).run(result)
    sys.stdout.flush()
