"""Import a submission into this very process and test it; then the next student's, likewise."""

import importlib
import os
import sys

folder, after = sys.argv[1:3]
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))  # noqa: PTH100, PTH120
os.chdir(folder)
sys.path.insert(0, os.getcwd())  # noqa: PTH109

arena = importlib.import_module("arena")
tests = importlib.import_module("hidden_tests")
tests.run_on(arena, "@@")

sys.modules.pop("arena")
sys.path.insert(0, after)
tests.run_on(importlib.import_module("arena"), "##")
