"""Tests of the analysis: `python3 -m analysis.tests` in experiments/."""

from pathlib import Path

RESULTS = Path(__file__).parents[3] / "docs" / "results"
