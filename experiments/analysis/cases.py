"""Cases of the suites `paper`, `locate` and `elsewhere-sim`: success, accuracy, what must not be accepted."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from .methods import in_order, label
from .plots import CYCLE, horizontal, legend_above
from .section import Section, Table
from .shares import by_group, counts, number, percent

SUITES = ("paper", "locate", "elsewhere-sim")
# Smallest (1) or largest (-1) value that a column of targets.csv allows for, and what it limits.
_LIMITS = {
    "min_success": (1, "success", "success ≥ {:.0%}"),
    "min_found": (1, "found_share", "found ≥ {:.0%}"),
    "max_accepted": (-1, "accepted_share", "accepted ≤ {:.0%}"),
    "max_false": (-1, "wrong_share", "wrong ≤ {:.0%}"),
    "max_refused": (-1, "refused_share", "refused ≤ {:.0%}"),
    "max_rms_m": (-1, "plane_median", "median ≤ {:.0f} mm"),
    "max_rms3d_m": (-1, "rms_median", "3-D ≤ {:.0f} mm"),
    "max_time_s": (-1, "time_median", "≤ {:.1f} s"),
}


def kind_of(case, dataset):
    """A case's name without its crop."""
    short = f"-{case}-".replace(f"-{dataset}-", "-").strip("-")
    return short or case


def _summary(rows):
    """Errors are over the successes: `plane` the horizontal RMS to the best affine."""
    right = rows[rows.success]
    found = int((rows.accepted & rows.right_in_plane).sum())
    return {
        "negative": bool(rows.negative.any()),
        **counts(rows),
        "found": found,
        "found_share": found / len(rows),
        "accepted": int(rows.accepted.sum()),
        "accepted_share": rows.accepted.mean(),
        "refused_share": (~rows.accepted).mean(),
        "wrong_share": (rows.accepted & ~rows.right).mean(),
        **{f"plane_{name}": right.rms_to_best_affine.quantile(q)
           for name, q in (("median", 0.5), ("p95", 0.95), ("worst", 1.0))},
        **{f"rms_{name}": right.rms.quantile(q) for name, q in (("median", 0.5), ("p95", 0.95))},
        **{f"time_{name}": rows.run_s.quantile(q) for name, q in (("median", 0.5), ("p95", 0.95))},
    }


def judge(line, target):
    """Text of a case's target, and whether it is met: `yes`, `no` or empty without any."""
    texts, met = [], []
    for column, (sign, figure, text) in _LIMITS.items():
        limit = target[column]
        if pd.isna(limit):
            continue
        worst = column == "max_rms_m" and target["worst_rms"] == 1
        value = line["plane_worst" if worst else figure]
        shown = text.replace("median", "worst") if worst else text
        texts.append(shown.format(1000 * limit if "mm" in text else limit))
        # What does not exist, as there was no success at all, meets nothing.
        met.append(sign * value >= sign * limit)
    return ", ".join(texts), ("yes" if all(met) else "no") if met else ""


def _with_targets(table, targets):
    judged = [judge(line, targets.loc[line["case_name"]]) if line["case_name"] in targets.index
              else ("", "") for _, line in table.iterrows()]
    return table.assign(target=[text for text, _ in judged], met=[met for _, met in judged])


def _shown(table, head):
    """The table as texts; `head` names what each line begins with."""
    def shares(hits):
        return ["–" if line.negative else percent(line[hits], line.runs)
                for _, line in table.iterrows()]

    def both(name, factor=1000):
        return [f"{number(a, 1, factor)} / {number(b, 1, factor)}" for a, b in zip(
            table[f"{name}_median"], table[f"{name}_p95"])]

    shown = pd.DataFrame({
        **{title: table[column] for column, title in head.items()},
        "pairs": table.runs, "accepted and right %": shares("successes"),
        "in the plane %": shares("found"), "wrong": table.wrong_accepted,
        "not accepted": table.not_accepted, "plane mm": both("plane"), "3-D mm": both("rms"),
        "time s": both("time", 1)})
    return without_single(shown)


def without_single(shown):
    """Without the column of methods where there is only one."""
    return shown.drop(columns="method") if shown.method.nunique() == 1 else shown


def _stated(rows):
    """In rows of earlier sources heights included."""
    return rows.probability.fillna(rows.plane_probability)


def _refusals(rows):
    """What must not be accepted unless it is right."""
    table = by_group(rows, ["case_kind", "method"], lambda group: {
        "negative": bool(group.negative.any()), **counts(group),
        "highest_wrong_probability": _stated(group)[~group.right].max()})
    return Table("refusals", table, without_single(pd.DataFrame({
        "kind": table.case_kind, "method": table.method, "pairs": table.runs,
        "has a right place": ["no" if one else "yes" for one in table.negative],
        "accepted and right": table.successes, "accepted and wrong": table.wrong_accepted,
        "refused": table.not_accepted, "highest probability of a wrong answer": [
            number(value, 2) for value in table.highest_wrong_probability]})))


def _variants(rows):
    """Several methods on the same pairs: what a change of one option does."""
    table = by_group(rows, ["method", "dataset"], _summary)
    shown = table.assign(text=[f"{number(v, 1, 1000)} mm" for v in table.plane_median]).pivot(
        index="method", columns="dataset", values="text").fillna("–")
    of = rows.groupby("method").success
    shown["right and accepted"] = of.sum().astype(str) + " of " + of.size().astype(str)
    return Table("variants", table, shown.loc[in_order(rows.method)].reset_index())


def _plot(rows):
    """Of each case and method the 5th, 50th and 95th percentile."""
    right = rows[rows.success].assign(mm=1000 * rows.rms_to_best_affine)
    methods, cases = in_order(right.method), list(dict.fromkeys(right.case_name))
    step = 0.8 / len(methods)
    height = 0.2 + 0.1 * (len(methods) - 1)
    figure = Figure(figsize=(9.0, height * len(cases) + 1.0), layout="constrained")
    axis = figure.subplots()
    for i, method in enumerate(methods):
        errors = right[right.method == method].groupby("case_name").mm
        y = np.array([cases.index(case) for case in errors.groups]) + step * (
            i - (len(methods) - 1) / 2)
        colour = CYCLE[i % len(CYCLE)]
        axis.hlines(y, errors.quantile(0.05), errors.quantile(0.95), color=colour, linewidth=3.5,
                    alpha=0.4)
        axis.plot(errors.median(), y, "o", color=colour, markersize=4.5, label=label(method))
    axis.set_yticks(range(len(cases)), cases)
    axis.set_ylim(len(cases) - 0.4, -0.6)
    axis.set_xlim(left=0)
    axis.set_xlabel("horizontal RMS to the best affine [mm]")
    horizontal(axis)
    if len(methods) > 1:
        legend_above(figure, *axis.get_legend_handles_labels())
    return figure


def section(rows):
    """Nothing without rows of these suites."""
    rows = rows[rows.suite.isin(SUITES)]
    if rows.empty:
        return None
    # In the order of the targets, which is that of the suites.
    targets = pd.read_csv(Path(__file__).with_name("targets.csv"), index_col="case")
    order = {case: place for place, case in enumerate(targets.index)}
    rows = rows.assign(
        case_kind=[kind_of(a, b) for a, b in zip(rows.case_name, rows.dataset)]).sort_values(
            ["case_name", "method"], kind="stable", key=lambda names: names.map(
                order if names.name == "case_name" else in_order(rows.method).index))
    table = _with_targets(by_group(rows, ["case_name", "method"], _summary), targets)
    traps = rows.negative | rows.case_kind.str.startswith("neg-")
    solvable = rows[~traps]
    tables = []
    for suite in SUITES:
        if (solvable.suite == suite).any():
            kinds = by_group(solvable[solvable.suite == suite], ["case_kind", "method"], _summary)
            tables.append(Table(f"kinds-{suite}", kinds, _shown(
                kinds, {"case_kind": "kind", "method": "method"})))
    if solvable.groupby(["case_name", "seed"]).method.nunique().max() > 1:
        tables.append(_variants(solvable))
    if traps.any():
        tables.append(_refusals(rows[traps]))
    shown = _shown(table, {"case_name": "case", "method": "method"})
    tables.append(Table("cases", table, shown.assign(target=table.target, met=table.met)))
    return Section("cases", {"accuracy": _plot(solvable)} if solvable.success.any() else {}, tables)
