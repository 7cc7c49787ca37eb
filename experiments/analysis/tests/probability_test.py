import json
import unittest

import numpy as np
import pandas as pd

from analysis import calibrate, probability, rows
from analysis.tests import RESULTS

FITTED = RESULTS / "calibration"


def drawn(count, weights, intercept=-0.7, seed=5):
    """Features of several sizes, and outcomes drawn from the model's probability."""
    random = np.random.default_rng(seed)
    names = list(probability.FEATURE_SIGNS)
    features = pd.DataFrame(random.normal(0.5, 1.5, (count, len(names))), columns=names)
    model = {"intercept": intercept, "weights": dict(zip(names, weights))}
    return features, random.random(count) < probability.stated(model, features), model


class CalibrateTest(unittest.TestCase):
    def test_recovers_the_model_that_drew_the_data(self):
        features, right, model = drawn(20000, [1.5, 2.0, 0.5, 0.2, 0.8, 0.1])
        fitted = calibrate.fit(features, right)
        self.assertAlmostEqual(fitted["intercept"], model["intercept"], delta=0.12)
        for name, weight in model["weights"].items():
            self.assertAlmostEqual(fitted["weights"][name], weight, delta=0.1)

    def test_a_weight_of_the_wrong_sign_is_left_out(self):
        features, right, _ = drawn(20000, [1.5, 2.0, -0.5, 0.2, -0.8, 0.1])
        weights = calibrate.fit(features, right)["weights"]
        self.assertEqual(weights["agreement_log_odds"], 0.0)
        self.assertEqual(weights["log_significance"], 0.0)
        self.assertGreater(weights["log_uniqueness"], 0.5)

    def test_needs_answers_of_both_kinds(self):
        features, right, _ = drawn(50, [1] * 6)
        with self.assertRaises(calibrate.CalibrationError):
            calibrate.fit(features, np.ones_like(right))

    def test_threshold_accepts_nothing_wrong(self):
        chosen = calibrate.threshold(np.array([0.1, 0.8, 0.7, 0.82, 0.95, 0.99]),
                                     np.array([False, False, True, True, True, True]))
        self.assertEqual(chosen["highest_wrong"], 0.8)
        self.assertAlmostEqual(chosen["probability"], 0.8683, places=3)
        self.assertEqual((chosen["right"], chosen["right_refused"]), (4, 2))

    def test_a_field_is_in_one_fold_only(self):
        features, right, _ = drawn(300, [1] * 6)
        field = np.repeat(np.arange(10), 30)
        together = calibrate.cross_validate(features, right, field)
        rest = ~np.isin(field, [3, 8])
        model = calibrate.fit(features[rest], right[rest])
        np.testing.assert_allclose(together[~rest], probability.stated(model, features[~rest]))

    def test_the_committed_calibration_is_that_of_the_committed_rows(self):
        made, _ = calibrate.calibrate({"fitted to": rows.read([FITTED / "rows.csv"])})
        kept = json.loads((FITTED / "calibration.json").read_text())
        self.assertEqual(made.keys(), kept.keys())
        self.assertAlmostEqual(made["intercept"], kept["intercept"], places=5)
        for name, weight in kept["weights"].items():
            self.assertAlmostEqual(made["weights"][name], weight, places=5)
        for name, figures in kept["sets"].items():
            for figure, value in figures.items():
                self.assertAlmostEqual(made["sets"][name][figure], value, places=6)


class StatedTest(unittest.TestCase):
    def test_features_are_those_of_the_program(self):
        """What the program stated in rows made with the committed weights."""
        model = json.loads((FITTED / "calibration.json").read_text())
        table = rows.read([RESULTS / "elsewhere" / "rows.csv"])
        # What contradicts the guess has none, whatever the features.
        table = table[(table.place_probability > 0) & (table.status != "ambiguous")]
        self.assertGreater(len(table), 100)
        np.testing.assert_allclose(probability.stated(model, probability.features(table)),
                                   table.place_probability, atol=1e-4)

    def test_what_is_not_known_counts_as_badly_as_it_can(self):
        known = pd.DataFrame({
            "uniqueness": [2.0], "decoy": [2.0], "agreeing": [9.0], "blocks": [10.0],
            "significance": [9.0], "overlap": [1.0]})
        features = probability.features(known)
        for column in known:
            unknown = probability.features(known.assign(**{column: np.nan}))
            worse = [name for name, sign in probability.FEATURE_SIGNS.items()
                     if sign * (unknown[name][0] - features[name][0]) < 0]
            better = [name for name, sign in probability.FEATURE_SIGNS.items()
                      if sign * (unknown[name][0] - features[name][0]) > 0]
            self.assertTrue(worse, column)
            self.assertFalse(better, column)

    def test_calibrated_statements_have_small_errors_and_bold_ones_do_not(self):
        random = np.random.default_rng(9)
        stated = random.random(20000)
        right = random.random(20000) < stated
        honest = probability.quality(stated, right)
        bold = probability.quality(np.where(stated < 0.5, 0.02, 0.98), right)
        for error in ("calibration_error_equal_mass", "calibration_error_equal_width"):
            self.assertLess(honest[error], 0.015)
            self.assertAlmostEqual(bold[error], 0.23, delta=0.03)
        # For statements that are uniform: the area is 5/6, the Brier score 1/6.
        self.assertAlmostEqual(honest["area_under_curve"], 5 / 6, delta=0.01)
        self.assertAlmostEqual(honest["brier"], 1 / 6, delta=0.01)

    def test_bins_have_their_lower_end(self):
        bins = probability.reliability(np.array([0.0, 0.1, 0.1, 0.3, 1.0]),
                                       np.array([False, True, False, True, True]))
        self.assertEqual(bins.low.round(3).tolist(), [0.0, 0.1, 0.3, 0.9])
        self.assertEqual(bins.answers.tolist(), [1, 2, 1, 1])


if __name__ == "__main__":
    unittest.main()
