"""Reads rows.csv. What the columns mean is said in experiments/runner/row.hpp."""

import csv
from pathlib import Path

import pandas as pd

TEXTS = ("suite", "settings", "case_name", "dataset", "kind", "told", "method", "status", "stages",
         "message", "source", "options")
WHOLE = ("seed", "field", "threads")
FLAGS = ("negative", "accepted", "right", "right_in_plane")
# The error of the strip's centre and what is stated of it.
CENTRE = ("centre_error_x", "centre_error_y", "centre_deviation_x", "centre_deviation_y",
          "centre_correlation")
# Empty where there is no such number.
NUMBERS = (
    "setting", "guess_scale", "guess_translation", "guess_heading",
    "rms", "rms_horizontal", "rms_vertical", "aligned_rms",
    "aligned_rms_horizontal", "best_affine_rms", "worst", "rms_to_best_affine", "e_t", "e_r", "e_s",
    "bend_gain", "slips", "slip_place", "places_covered",
    "plane_probability", "place_probability", "uniqueness", "significance", "decoy",
    "agreeing", "blocks", "expected_rms", "systematic_rms", "scatter_rms", "local_rms",
    "height_deviation",
    "heights_limited",
    "overlap", "block_rms", "correlation", "attempts", "pose_mahalanobis2", "centre_mahalanobis2", "height_mahalanobis2",
    *CENTRE, "height_error",
    "matches", "matches_right", "matches_coherent", "rematches", "rematches_right",
    "rematches_coherent", "fixed_points", "moving_points", "make_s", "run_s", "cpu_s")
COLUMNS = TEXTS + WHOLE + FLAGS + NUMBERS
# Of rows of earlier sources, where a run could be a process of its own (`in_process` 0): its wall
# time, reading included, which `cpu_s` then covers, too; its memory, and that before it read; and
# where the stated probability was that of being right in the plane and in height.
EARLIER = ("in_process", "wall_s", "peak_mib", "idle_mib", "probability")
# Rows that documents quote may be older than these.
LATER = ("place_probability", "decoy", "systematic_rms", "aligned_rms", "aligned_rms_horizontal",
         "best_affine_rms", "bend_gain", "slips", "slip_place", "places_covered",
         "heights_limited", "height_error", "scatter_rms", *CENTRE)
KEY = ["suite", "settings", "case_name", "seed", "setting", "guess_scale", "method"]
STATUSES = ("accepted", "rejected", "ambiguous", "failed", "skipped")


class RowError(Exception):
    """A file of rows that cannot be used; the message names file, line and what is wrong."""


def _lines(path):
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RowError(f"{path}: cannot be read: {error}") from error
    if not text:
        raise RowError(f"{path}: is empty; it needs the line with the columns' names")
    # A last line without its end was cut off when the runner was stopped; it runs that pair again.
    whole = text[:text.rfind("\n") + 1]
    return list(csv.reader(whole.splitlines(), quoting=csv.QUOTE_NONE))


def _check_header(path, header):
    missing = [name for name in COLUMNS if name not in header and name not in LATER]
    unknown = [name for name in header if name not in COLUMNS + EARLIER]
    if missing or unknown or len(set(header)) != len(header):
        raise RowError(
            f"{path}:1: these are not the columns of this version (experiments/runner/row.hpp): "
            f"missing: {', '.join(missing) or 'none'}; unknown: {', '.join(unknown) or 'none'}")


def _first(path, frame, bad, column, what):
    """Raises for the first of the bad rows."""
    if bad.any():
        place = bad.idxmax()
        raise RowError(f"{path}:{place + 2}: {column}: '{frame[column][place]}' is {what}")


def _typed(path, frame):
    for column in FLAGS:
        _first(path, frame, ~frame[column].isin(["0", "1"]), column, "neither 0 nor 1")
    _first(path, frame, ~frame["status"].isin(STATUSES), "status", f"none of {STATUSES}")
    numbers = {}
    for column in WHOLE + NUMBERS + EARLIER:
        values = pd.to_numeric(frame[column], errors="coerce")
        empty = frame[column] == ""
        _first(path, frame, (values.isna() & ~empty) | values.abs().eq(float("inf")), column,
               "no number")
        if column in WHOLE:
            _first(path, frame, empty | (values % 1 != 0), column, "no whole number")
            values = values.astype("int64")
        numbers[column] = values
    return frame.assign(**numbers, **{column: frame[column] == "1" for column in FLAGS})


def read(paths):
    """All rows of the files as one table, with `success`: right, and the method stands by it.

    Raises RowError, also for a run that is there twice.
    """
    tables = []
    for path in paths:
        lines = _lines(path)
        _check_header(path, lines[0])
        for number, line in enumerate(lines[1:], start=2):
            if len(line) != len(lines[0]):
                raise RowError(f"{path}:{number}: has {len(line)} fields, not {len(lines[0])}")
        table = _typed(path, pd.DataFrame(lines[1:], columns=lines[0]).reindex(
            columns=COLUMNS + EARLIER, fill_value=""))
        tables.append(table.assign(place=[f"{path}:{i + 2}" for i in table.index]))
    rows = pd.concat(tables, ignore_index=True)
    double = rows.duplicated(KEY)
    if double.any():
        again = rows[double].iloc[0]
        before = rows[(rows[KEY] == again[KEY]).all(axis=1)].iloc[0]
        raise RowError(f"{again.place}: the same run as {before.place}: "
                       + ", ".join(f"{name} {again[name]}" for name in KEY))
    return rows.assign(success=rows.accepted & rows.right)
