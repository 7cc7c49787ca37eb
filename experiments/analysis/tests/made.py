"""Rows that tests make up."""

from analysis.rows import COLUMNS, FLAGS, WHOLE

_ROW = {
    "suite": "paper", "settings": "final", "case_name": "soybean-joint", "dataset": "soybean",
    "kind": "simulated", "seed": "7", "setting": "0", "guess_scale": "0", "method": "default",
    "threads": "1", "status": "accepted", "accepted": "1", "right": "1", "right_in_plane": "1",
    "rms": "0.02", "rms_horizontal": "0.01", "rms_to_best_affine": "0.008", "e_t": "0.01",
    "e_r": "0.002", "e_s": "0.004", "run_s": "0.5", "stages": "level=0.1;search=0.3",
    "source": "abc", "options": "def"}


def line(**values):
    row = {**dict.fromkeys(COLUMNS, ""), **dict.fromkeys(FLAGS + WHOLE, "0"), **_ROW, **values}
    return ",".join(str(row[name]) for name in COLUMNS)


def write(path, lines, header=COLUMNS):
    path.write_text("\n".join([",".join(header), *lines]) + "\n", encoding="utf-8")
    return path
