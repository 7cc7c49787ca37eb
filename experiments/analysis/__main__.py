"""The command line of `experiments/analyse` and `experiments/calibrate`."""

import argparse
import json
import sys
from pathlib import Path

from . import calibrate, honesty, report
from .rows import RowError, read


def _analyse(arguments):
    parser = argparse.ArgumentParser(
        prog="analyse", description="Plots, tables and a page of the rows of experiments.",
        epilog="In a document the lines from '<!-- analyse: FOLDER/TABLE -->' to '<!-- end -->' "
        "become that table of tables.md; FOLDER is the name of the output.")
    parser.add_argument("rows", nargs="+", type=Path, help="rows.csv, one or more")
    parser.add_argument("-o", "--output", type=Path,
                        help="folder for *.svg, *.csv, index.html and tables.md; without it, prints "
                        "what was accepted, how far off it is and whether what is stated holds")
    parser.add_argument("--title", default="Registration experiments", help="of the page")
    parser.add_argument("--document", type=Path, help="Markdown whose marked tables to update")
    given = parser.parse_args(arguments)
    if not given.output:
        print(honesty.text(read(given.rows)))
        return
    tables = report.write(read(given.rows), given.output, given.title)
    if given.document:
        text = given.document.read_text(encoding="utf-8")
        given.document.write_text(
            report.update_document(text, given.output.resolve().name, tables), encoding="utf-8")
    print(given.output / "index.html")


def _calibrate(arguments):
    parser = argparse.ArgumentParser(
        prog="calibrate", description="Fits the probability that a registration is the right place to rows "
        "of pairs with known truth.")
    parser.add_argument("rows", nargs="+", type=Path, help="rows.csv to fit to, one or more")
    parser.add_argument("--test", nargs="+", type=Path, default=[], help="rows.csv to test on")
    parser.add_argument("-o", "--output", type=Path, required=True,
                        help="folder for calibration.json and reliability.csv")
    parser.add_argument("--method", default="default", help="whose rows [default]")
    given = parser.parse_args(arguments)
    rows = {"fitted to": read(given.rows)}
    if given.test:
        rows["tested on"] = read(given.test)
    made, bins = calibrate.calibrate(
        {purpose: of[of.method == given.method] for purpose, of in rows.items()})
    given.output.mkdir(parents=True, exist_ok=True)
    text = json.dumps(made, indent=2)
    (given.output / "calibration.json").write_text(text + "\n", encoding="utf-8")
    bins.to_csv(given.output / "reliability.csv", index=False, float_format="%.6f")
    print(text)


def main(command, arguments):
    try:
        {"analyse": _analyse, "calibrate": _calibrate}[command](arguments)
    except (RowError, report.DocumentError, calibrate.CalibrationError, OSError) as error:
        sys.exit(f"{command}: {error}")


if __name__ == "__main__":
    main("analyse", sys.argv[1:])
