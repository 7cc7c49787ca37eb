import tempfile
import unittest
from pathlib import Path

from analysis import heights, rows
from analysis.tests import made


def _read(lines):
    with tempfile.TemporaryDirectory() as folder:
        return rows.read([made.write(Path(folder) / "rows.csv", lines)])


def _line(**values):
    return made.line(**{"suite": "heights", "case_name": "heights-fair-wheat", "dataset": "wheat",
                        "height_deviation": 0.02, "heights_limited": 0, "height_error": -0.01,
                        **values})


class HeightsTest(unittest.TestCase):
    def test_limited_heights_need_not_be_within_but_inside_what_is_stated(self):
        table = heights.table(_read([
            _line(seed=1), _line(seed=2, height_error=0.035),
            _line(seed=3, height_error=0.1, heights_limited=1, height_deviation=0.04),
            _line(seed=4, accepted=0, height_error=1.0)]))
        line = table[table.crop == "wheat"].iloc[0]
        self.assertEqual(line["accepted"], 3)
        self.assertEqual(line["limited %"][:4], "33.3")
        self.assertEqual(line["measured within"], "1 of 2 (3 cm)")
        self.assertEqual(line["worst mm"], "35")
        self.assertEqual(line["worst limited mm"], "100")
        self.assertEqual(line["inside 2 deviations %"][:4], "66.7")

    def test_hard_views_have_a_wider_limit_and_rows_of_their_own(self):
        table = heights.table(_read([
            _line(seed=1), _line(seed=2, case_name="heights-hard-other-barley",
                                 height_error=0.04)]))
        self.assertEqual(table.crop.tolist(), ["wheat", "other-barley", "all", "all"])
        self.assertEqual(table["measured within"].tolist()[1], "1 of 1 (5 cm)")

    def test_other_suites_have_none(self):
        self.assertIsNone(heights.section(_read([made.line()])))


if __name__ == "__main__":
    unittest.main()
