"""Counts of rows, and shares with Wilson's 95 % interval."""

from functools import lru_cache

import pandas as pd
from scipy.stats import binomtest


@lru_cache(maxsize=None)
def wilson(hits, trials):
    """Wilson's 95 % interval of a share; (0, 1) without trials."""
    if trials == 0:
        return 0.0, 1.0
    interval = binomtest(int(hits), int(trials)).proportion_ci(method="wilson")
    return interval.low, interval.high


def percent(hits, trials):
    """`97.9 (94.1–99.3)`; a dash without trials."""
    if trials == 0:
        return "–"
    low, high = wilson(hits, trials)
    return f"{100 * hits / trials:.1f} ({100 * low:.1f}–{100 * high:.1f})"


def number(value, digits, factor=1.0):
    """A dash for what does not exist."""
    return "–" if pd.isna(value) else f"{factor * value:.{digits}f}"


def counts(rows):
    """What the runs of one group came to. Skipped ones count as failures."""
    low, high = wilson(int(rows.success.sum()), len(rows))
    return {
        "runs": len(rows),
        "successes": int(rows.success.sum()),
        "success": rows.success.mean(),
        "success_low": low,
        "success_high": high,
        "right": int(rows.right.sum()),
        "wrong_accepted": int((rows.accepted & ~rows.right).sum()),
        "not_accepted": int((~rows.accepted).sum()),
        "skipped": int((rows.status == "skipped").sum()),
    }


def by_group(rows, columns, summary):
    """A row of `summary` for each group of rows that are alike in `columns`, in order of
    appearance."""
    return pd.DataFrame([
        {**dict(zip(columns, key if isinstance(key, tuple) else (key,))), **summary(group)}
        for key, group in rows.groupby(columns if len(columns) > 1 else columns[0], sort=False)])
