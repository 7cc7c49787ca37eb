"""What the paper reports on its real data: paper_figures.csv, tables named as in its source.

err_statistic: e_t / e_R / e_s of the successes over the scale error; inliers_percentage [%];
timings_tab: min / max / avg [s]; correct_reg_rate: shares without scale error, as released with the
authors' code, at the setting of ours that they stand beside; `share` is the middle of a range.
"""

from functools import lru_cache
from pathlib import Path

import pandas as pd

# The paper's crops that strips cut from real imagery stand for.
_CROPS = {"semireal-sugarbeet": "sugar-beet-10m", "real-soybean": "soybean"}


@lru_cache(maxsize=None)
def _figures():
    figures = pd.read_csv(Path(__file__).with_name("paper_figures.csv"),
                          keep_default_na=False, dtype={"text": str})
    return figures.assign(setting=pd.to_numeric(figures.setting),
                          share=pd.to_numeric(figures.share))


def crop_of(dataset):
    """The paper's crop that a data set stands for; of real pairs, `<folder>/<row>`, the one that
    the folder is called after, and `sugar-beet` where it does not say from how high."""
    if "/" not in dataset:
        return _CROPS.get(dataset, dataset)
    name = "".join(c for c in dataset.rsplit("/", 1)[0].lower() if c.isascii() and c.isalnum())
    if "soy" in name:
        return "soybean"
    if "wheat" in name:
        return "winter-wheat"
    if "beet" not in name:
        return ""
    return "sugar-beet" + ("-10m" if "10m" in name else "-20m" if "20m" in name else "")


def text(table, method, dataset=None, setting=None):
    """A cell as the paper prints it; empty where it has none. One sugar beet in
    inliers_percentage."""
    rows = _figures()
    rows = rows[(rows.table == table) & (rows.method == method)]
    if dataset is not None:
        crop = crop_of(dataset)
        rows = rows[rows.crop.map(lambda known: bool(crop) and crop.startswith(known)).astype(bool)]
    if setting is not None:
        rows = rows[(rows.setting - setting).abs() < 1e-9]
    return rows.text.iloc[0] if len(rows) else ""


def curve(suite, method):
    """Settings and shares of a success curve without scale error; empty where it gives none."""
    rows = _figures()
    rows = rows[(rows.table == f"correct_reg_rate {suite}") & (rows.method == method)]
    return rows[["setting", "share"]].sort_values("setting")
