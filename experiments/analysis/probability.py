"""What the stated probability is worth: bins, calibration errors, and the features it rests on.

The features repeat agricolmap::verdict::verdictFeatures (src/agricolmap/verdict/probability.cpp);
a test recomputes the probabilities of the place that the program stated in committed rows.
"""

import numpy as np
import pandas as pd
from scipy.special import expit
from sklearn.metrics import brier_score_loss, roc_auc_score

from .shares import wilson

# A registration is right within this RMS displacement [m].
RIGHT_RMS_M = 0.05
# It is the right place, row and plant, within this.
PLACE_RMS_M = 0.10
# Share of blocks that agree by chance: a circle of 8 cm in one of half a metre.
CHANCE_AGREEMENT = 0.026
# Each feature with whether more of it speaks for the place (1) or against it (-1).
FEATURE_SIGNS = {
    "log_uniqueness": 1,
    "log_decoy": 1,
    "agreement_log_odds": 1,
    "agreement_beyond_chance": 1,
    "log_significance": 1,
    "log_overlap": 1,
}
BINS = 10


def right(rows, plane=False):
    """In space, or in the plane whatever the height."""
    rms = rows.rms_horizontal if plane else rows.rms
    return (~rows.negative & (rms <= RIGHT_RMS_M)).to_numpy()


def right_place(rows):
    return (~rows.negative & (rows.rms_horizontal <= PLACE_RMS_M)).to_numpy()


def _log_within(values, low, high, unknown):
    return np.log(np.where(np.isnan(values), unknown, np.clip(values, low, high)))


def features(rows):
    """The verdict's features of each row; what is not known counts as badly as it can."""
    column = {name: rows[name].to_numpy(float) for name in (
        "uniqueness", "decoy", "agreeing", "blocks", "significance", "overlap")}
    blocks = np.where(column["blocks"] >= 1, np.minimum(column["blocks"], 1e6), 1)
    agreeing = np.where(column["agreeing"] >= 0, np.minimum(column["agreeing"], blocks), 0)
    # Twice the log-likelihood ratio of the agreeing blocks against chance, on the scale of a
    # deviation, its sign that of the excess.
    share = np.clip(agreeing / blocks, 1e-6, 1 - 1e-6)
    divergence = share * np.log(share / CHANCE_AGREEMENT) + (1 - share) * np.log(
        (1 - share) / (1 - CHANCE_AGREEMENT))
    beyond = np.log1p(np.sqrt(2 * blocks * np.maximum(0, divergence)))
    return pd.DataFrame({
        "log_uniqueness": _log_within(column["uniqueness"], 0.3, 4, 0.3),
        "log_decoy": _log_within(column["decoy"], 0.3, 4, 0.3),
        "agreement_log_odds": np.log((agreeing + 0.5) / (blocks - agreeing + 0.5)),
        "agreement_beyond_chance": np.where(share < CHANCE_AGREEMENT, -beyond, beyond),
        "log_significance": _log_within(column["significance"], 1, 30, 1),
        "log_overlap": _log_within(column["overlap"], 0.05, 1, 0.05),
    }, index=rows.index)


def stated(model, of_features):
    """The probabilities that a fitted model, as calibration.json has it, states."""
    weights = np.array([model["weights"][name] for name in FEATURE_SIGNS])
    return expit(model["intercept"] + of_features[list(FEATURE_SIGNS)].to_numpy() @ weights)


def _bins(parts):
    """`parts`: probabilities, whether right, and the range of the statements."""
    columns = ["low", "high", "answers", "right", "mean_probability", "right_low", "right_high"]
    return pd.DataFrame([
        (low, high, len(hits), int(hits.sum()), stated_here.mean(),
         *wilson(int(hits.sum()), len(hits))) for stated_here, hits, low, high in parts],
        columns=columns)


def reliability(probabilities, right):
    """Ten bins of equal width, those without statements left out."""
    place = np.searchsorted(np.arange(1, BINS) / BINS, probabilities, side="right")
    return _bins((probabilities[place == b], right[place == b], b / BINS, (b + 1) / BINS)
                 for b in range(BINS) if (place == b).any())


def _equal_mass(probabilities, right):
    order = np.argsort(probabilities, kind="stable")
    edges = [b * len(order) // BINS for b in range(BINS + 1)]
    parts = [order[a:b] for a, b in zip(edges, edges[1:]) if b > a]
    return _bins((probabilities[part], right[part], *probabilities[part[[0, -1]]])
                 for part in parts)


def quality(probabilities, right):
    """What a set of statements is worth; no area under the curve without answers of both kinds."""
    probabilities, right = np.asarray(probabilities, float), np.asarray(right, bool)

    def error(bins):
        return float((bins.right - bins.mean_probability * bins.answers).abs().sum() / len(right))

    both = 0 < right.sum() < len(right)
    return {"answers": len(right), "right": int(right.sum()),
            "area_under_curve": float(roc_auc_score(right, probabilities)) if both else np.nan,
            "calibration_error_equal_mass": error(_equal_mass(probabilities, right)),
            "calibration_error_equal_width": error(reliability(probabilities, right)),
            "brier": float(brier_score_loss(right, probabilities, pos_label=True))}
