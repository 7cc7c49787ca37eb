"""Runs all tests; exit code 77 where the packages are missing, which ctest shows as skipped."""

import sys
import unittest
from pathlib import Path

try:
    import jinja2, matplotlib, pandas, scipy, sklearn  # noqa: F401, E401
except ModuleNotFoundError as error:
    print(f"skipped: {error}; scripts/install-dependencies --experiments installs it")
    sys.exit(77)

suite = unittest.defaultTestLoader.discover(
    str(Path(__file__).parent), pattern="*_test.py", top_level_dir=str(Path(__file__).parents[2]))
sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
