import tempfile
import unittest
from pathlib import Path

from analysis import honesty, rows
from analysis.tests import made


def _table(lines):
    with tempfile.TemporaryDirectory() as folder:
        return rows.read([made.write(Path(folder) / "rows.csv", lines)])


def _dates(**values):
    return made.line(**{"suite": "dates", "case_name": "dates-1w-15-22", "dataset": "15-22",
                        "plane_probability": 0.9, "expected_rms": 0.01, "pose_mahalanobis2": 3,
                        "centre_mahalanobis2": 1, "height_mahalanobis2": 9, **values})


class HonestyTest(unittest.TestCase):
    def test_counts_by_what_the_plane_is_off(self):
        line = honesty._summary(_table([
            _dates(seed=1), _dates(seed=2, rms_horizontal=0.06, right_in_plane=0),
            _dates(seed=3, rms_horizontal=0.3, right_in_plane=0, plane_probability=0.85),
            _dates(seed=4, accepted=0, status="rejected")]))
        self.assertEqual(line["accepted %"][:4], "75.0")
        self.assertEqual(line["and ≤ 5 cm %"][:4], "25.0")
        self.assertEqual(line["≤ 8 cm %"][:4], "50.0")
        self.assertEqual((line["found ≤ 5 cm"], line["> 24 cm"], line["wrong p"]), (2, 1, "0.90"))
        self.assertEqual(line["wrong > 5 cm %"][:4], "50.0")
        self.assertEqual(line["plane mm"].split(" / ")[0], "60.0")

    def test_what_belongs_nowhere_is_wrong_however_near(self):
        line = honesty._summary(_table([_dates(suite="mirrored", negative=1)]))
        self.assertEqual((line["and ≤ 5 cm %"][:3], line["> 24 cm"]), ("0.0", 1))

    def test_statements_are_held_against_accepted_answers(self):
        line = honesty._stated(_table([
            _dates(seed=seed, pose_mahalanobis2=d, accepted=accepted)
            for seed, d, accepted in ((1, 3, 1), (2, 9, 1), (3, 10, 1), (4, 1, 0))]))
        self.assertEqual(line["accepted"], 3)
        self.assertEqual(line["pose in 50%"][:4], "33.3")
        self.assertEqual(line["pose in 90%"][:4], "66.7")
        self.assertEqual(line["height in 90%"][:3], "0.0")
        self.assertEqual((line["answers"], line["ECE"]), (4, "0.100"))

    def test_what_all_strips_of_two_flights_share_is_taken_off(self):
        # 3 cm of georeference and 1 cm of our own, where 8 mm each way are stated.
        rows_of = _table([
            _dates(seed=seed, centre_error_x=0.03 + x, centre_error_y=y, centre_deviation_x=0.008,
                   centre_deviation_y=0.008, centre_correlation=0)
            for seed, (x, y) in enumerate([(0.01, 0), (-0.01, 0), (0, 0.01), (0, -0.01), (0, 0)])])
        table = honesty._without_common(rows_of)
        self.assertEqual(table["common x, y cm"][0], "3.0, 0.0")
        self.assertEqual(table["left over cm RMS"][0], "1.0")
        self.assertEqual(table["inside the 90 % ellipse"][0][:5], "100.0")
        self.assertIsNone(honesty._without_common(rows_of[:4]))

    def test_prints_kinds_cases_and_statements(self):
        text = honesty.text(_table([_dates(), _dates(suite="mirrored", negative=1, rms="",
                                                     rms_horizontal="")]))
        kinds, cases, stated = text.split("\n\n")
        self.assertIn("dates-1w ", kinds)
        self.assertIn("dates-1w-15-22", cases)
        self.assertIn("true over stated RMS", stated)


if __name__ == "__main__":
    unittest.main()
