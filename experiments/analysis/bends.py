"""How strips that drift has bent, or that slipped, are followed."""

import pandas as pd

from .section import Section, Table
from .shares import percent

# Suites of such strips.
SUITES = ("bends", "slips")


def _kind(row):
    """The case without its crop."""
    name = row.case_name
    return name[:-len(row.dataset) - 1] if name.endswith(row.dataset) else name


def _line(rows):
    within = rows.accepted & (rows.aligned_rms <= 0.05)
    followed = rows[rows.bend_gain.notna()]
    slipped = rows.slip_place.dropna()
    return {
        "strips": len(rows),
        "accepted": int(rows.accepted.sum()),
        "followed": len(followed),
        "within 5 cm": int(within.sum()),
        "accepted beyond": int((rows.accepted & ~within).sum()),
        "best affine mm": rows.best_affine_rms.median() * 1e3,
        "transform mm": rows.rms.median() * 1e3,
        "aligned mm": rows.aligned_rms.median() * 1e3,
        "in the plane mm": rows.aligned_rms_horizontal.median() * 1e3,
        "worse by mm": (rows.aligned_rms - rows.rms).max() * 1e3,
        "slips within 0.5 m %": percent(int((slipped <= 0.5).sum()), len(slipped)),
        "places inside 90 % ellipse": followed.places_covered.mean(),
    }


def section(rows):
    """Nothing without rows of these suites."""
    of = rows[rows.suite.isin(SUITES) & rows.aligned_rms.notna()]
    if of.empty:
        return None
    kinds = of.apply(_kind, axis=1)
    full = pd.DataFrame([{"method": method, "kind": kind, **_line(part)}
                         for (method, kind), part in of.groupby([of.method, kinds], sort=False)])
    shown = full.copy()
    for name in full.columns[full.columns.str.endswith(" mm")]:
        shown[name] = full[name].map("{:.1f}".format)
    name = "places inside 90 % ellipse"
    shown[name] = full[name].map(lambda v: "–" if pd.isna(v) else f"{v:.2f}")
    return Section("bends", {}, [Table("bends", full, shown)])
