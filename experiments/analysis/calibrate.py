"""Fits the verdict's probability of the place to rows of pairs with known truth.

A logistic regression with an L2 penalty on standardised weights, whose signs are bound: more
evidence never makes a registration less probable. The weights belong into
src/agricolmap/verdict/probability.cpp, where a test holds them against the committed files.
"""

import numpy as np
import pandas as pd
from scipy.optimize import minimize
from scipy.special import expit, logit

from .probability import (FEATURE_SIGNS, PLACE_RMS_M, features, quality, reliability, right_place,
                          stated)

RIDGE = 1.0
FOLDS = 5
# Logit between the highest wrong answer and the threshold that is proposed.
MARGIN = 0.5


class CalibrationError(Exception):
    """Rows that a model cannot be fitted to."""


def samples(rows):
    """The answers among the rows: features, whether right, field; and the rows without an answer."""
    answered = rows.rms.notna() & rows.uniqueness.notna()
    answers = rows[answered]
    return features(answers), right_place(answers), answers.field.to_numpy(), rows[~answered]


def fit(of_features, right):
    """Maximum likelihood with the penalty and the signs; raises CalibrationError without both
    kinds of answers."""
    if right.all() or not right.any():
        raise CalibrationError(
            "a regression needs right and wrong answers; there are none of one kind")
    values = of_features[list(FEATURE_SIGNS)].to_numpy()
    mean, spread = values.mean(axis=0), np.maximum(values.std(axis=0), 1e-9)
    design = np.column_stack([np.ones(len(values)), (values - mean) / spread])
    penalty = np.r_[0.0, np.full(len(FEATURE_SIGNS), RIDGE)]

    def cost(beta):
        z = design @ beta
        value = np.logaddexp(0, z).sum() - z[right].sum() + 0.5 * penalty @ beta**2
        return value, design.T @ (expit(z) - right) + penalty * beta

    bounds = [(None, None)] + [(0, None) if sign > 0 else (None, 0)
                               for sign in FEATURE_SIGNS.values()]
    found = minimize(cost, np.zeros(len(bounds)), jac=True, method="L-BFGS-B", bounds=bounds,
                     options={"ftol": 1e-15, "gtol": 1e-9, "maxiter": 10000, "maxls": 100})
    weights = found.x[1:] / spread
    return {"intercept": float(found.x[0] - weights @ mean),
            "weights": {name: float(weight) + 0.0 for name, weight in zip(FEATURE_SIGNS, weights)}}


def cross_validate(of_features, right, field):
    """What each answer is said to be by a model fitted to the other folds; a field, whatever its
    case, is in one fold only."""
    fold_of = {seed: i % FOLDS for i, seed in enumerate(np.unique(field))}
    fold = np.array([fold_of[seed] for seed in field])
    probabilities = np.empty(len(right))
    for left_out in np.unique(fold):
        model = fit(of_features[fold != left_out], right[fold != left_out])
        probabilities[fold == left_out] = stated(model, of_features[fold == left_out])
    return probabilities


def threshold(probabilities, right):
    """The lowest that accepts nothing wrong, with a margin; never below one half."""
    highest = float(probabilities[~right].max(initial=0.0))
    chosen = max(0.5, float(expit(logit(np.clip(highest, 1e-9, 1 - 1e-9)) + MARGIN)))
    refused = int((probabilities[right] < chosen).sum())
    return {"probability": chosen, "highest_wrong": highest, "right": int(right.sum()),
            "right_refused": refused, "refusal_rate": refused / max(1, int(right.sum()))}


def _set(probabilities, right, from_threshold):
    return {**quality(probabilities, right),
            "wrong_accepted": int((probabilities[~right] >= from_threshold).sum()),
            "right_refused": int((probabilities[right] < from_threshold).sum())}


def _origin(purpose, rows):
    return "".join(
        f"{purpose} {len(of)} rows: suite {suite}, {settings} settings, source {source}, seeds "
        f"{of.seed.min()} to {of.seed.max()}\n"
        for (suite, settings, source), of in rows.groupby(["suite", "settings", "source"],
                                                          sort=False))


def calibrate(rows):
    """`rows`: those "fitted to" and, perhaps, "tested on". What calibration.json holds, and the
    bins of the reliability diagrams."""
    of_features, right, field, unanswered = samples(rows["fitted to"])
    model = fit(of_features, right)
    unseen = cross_validate(of_features, right, field)
    chosen = threshold(unseen, right)
    statements = {"cross-validation": (unseen, right), "fit": (stated(model, of_features), right)}
    if "tested on" in rows:
        test_features, test_right, _, _ = samples(rows["tested on"])
        statements["test"] = (stated(model, test_features), test_right)
    made = {
        "origin": "".join(_origin(purpose, of) for purpose, of in rows.items()),
        "right": {"rms_horizontal_m": PLACE_RMS_M},
        **model,
        "threshold": chosen,
        "rows_without_answer": len(unanswered),
        "solvable_without_answer": int((~unanswered.negative).sum()),
        "sets": {name: _set(*of, chosen["probability"]) for name, of in statements.items()},
    }
    bins = pd.concat([reliability(*of).assign(set=name) for name, of in statements.items()])
    return made, bins[["set"] + [name for name in bins if name != "set"]]
