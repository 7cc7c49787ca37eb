import re
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd

from analysis import cases, costs, methods, paper, report, rows, shares, success
from analysis.tests import RESULTS, made

DOCUMENTS = RESULTS.parent


def read(lines):
    with tempfile.TemporaryDirectory() as folder:
        return rows.read([made.write(Path(folder) / "rows.csv", lines)])


class SharesTest(unittest.TestCase):
    def test_wilson_is_that_of_the_books(self):
        low, high = shares.wilson(45, 50)
        self.assertAlmostEqual(low, 0.7864, places=4)
        self.assertAlmostEqual(high, 0.9565, places=4)
        self.assertEqual(shares.wilson(0, 0), (0.0, 1.0))
        self.assertEqual(shares.percent(4, 4), "100.0 (51.0–100.0)")
        self.assertEqual(shares.percent(0, 0), "–")

    def test_counts_tell_wrong_from_refused(self):
        counts = shares.counts(read([
            made.line(seed=1), made.line(seed=2, right=0),
            made.line(seed=3, accepted=0, status="rejected"),
            made.line(seed=4, accepted=0, right=0, status="skipped", rms="")]))
        self.assertEqual([counts[name] for name in ("runs", "successes", "right", "wrong_accepted",
                                                    "not_accepted", "skipped")], [4, 1, 2, 1, 2, 1])


class CasesTest(unittest.TestCase):
    def test_kind_is_the_case_without_its_crop(self):
        self.assertEqual(cases.kind_of("neg-other-field-none-maize", "maize"),
                         "neg-other-field-none")
        self.assertEqual(cases.kind_of("none-50m-closed-soybean", "soybean"), "none-50m-closed")
        self.assertEqual(cases.kind_of("sugar-beet-10m-easy", "sugar-beet-10m"), "easy")
        self.assertEqual(cases.kind_of("real-soybean", "real-soybean"), "real-soybean")

    def test_targets_are_judged(self):
        target = pd.Series({name: float("nan") for name in cases._LIMITS} | {
            "worst_rms": 1, "min_success": 0.98, "max_rms_m": 0.02})
        line = {"success": 1.0, "plane_worst": 0.019, "plane_median": 0.005}
        self.assertEqual(cases.judge(line, target), ("success ≥ 98%, worst ≤ 20 mm", "yes"))
        self.assertEqual(cases.judge({**line, "plane_worst": 0.021}, target)[1], "no")
        self.assertEqual(cases.judge({**line, "plane_worst": float("nan")}, target)[1], "no")

    def test_pairs_without_a_right_place_are_counted_apart(self):
        section = cases.section(read([
            made.line(), made.line(case_name="neg-mirrored-soybean", suite="locate", negative=1,
                                   right=0, plane_probability=0.7)]))
        tables = {table.name: table.shown for table in section.tables}
        self.assertEqual(tables["refusals"]["accepted and wrong"].tolist(), [1])
        self.assertEqual(tables["kinds-paper"]["pairs"].tolist(), [1])
        self.assertNotIn("kinds-locate", tables)


class MethodsTest(unittest.TestCase):
    def test_go_icp_is_counted_by_what_it_holds(self):
        held = methods.with_held_answers(read([
            made.line(method="go-icp", status="rejected", accepted=0),
            made.line(method="paper", status="rejected", accepted=0)]))
        self.assertEqual(held.success.tolist(), [True, False])

    def test_methods_are_compared_on_the_pairs_of_both(self):
        lines = [made.line(suite="translation", setting=1, seed=seed, method=method, right=right)
                 for seed, method, right in ((1, "default", 1), (2, "default", 0), (1, "paper", 1))]
        table = next(table for table in success.section(read(lines)).tables
                     if table.name == "contests")
        self.assertEqual(table.shown.iloc[0].tolist(), ["paper", 1, 0, 1, 0])

    def test_time_of_other_programs_is_taken_off(self):
        seconds = costs.computing_seconds(read([
            made.line(seed=1, run_s=2, cpu_s=1, wall_s=2), made.line(seed=2, run_s=2),
            made.line(seed=3, run_s=2, cpu_s=4, wall_s=2, threads=2)]))
        self.assertEqual(seconds.tolist(), [1.0, 2.0, 2.0])


class PaperTest(unittest.TestCase):
    def test_figures_are_found_by_crop(self):
        self.assertEqual(paper.text("err_statistic", "paper", "semireal-sugarbeet", 0.1),
                         "0.04 m / 0.04° / 2.0 %")
        self.assertEqual(paper.text("inliers_percentage", "paper", "Soy field/row1"), "54.5 ± 13.2")
        self.assertEqual(paper.text("inliers_percentage", "paper", "sugar-beet-20m"), "68.1 ± 13.6")
        self.assertEqual(paper.text("err_statistic", "paper", "maize", 0.1), "")
        self.assertEqual(paper.text("err_statistic", "orb", "beet_10m/row2", 0.3), "fail")
        self.assertEqual(paper.curve("translation", "go-icp").share.tolist(), [0.98, 0.79, 0.0])


class ReportTest(unittest.TestCase):
    def test_writes_plots_tables_and_page_the_same_each_time(self):
        lines = [made.line(suite=suite, setting=setting, seed=seed, method=method, plane_probability=p,
                           case_name="soybean", pose_mahalanobis2=3)
                 for suite in ("translation", "accuracy") for setting in (0, 0.05)
                 for seed, p in ((1, 0.9), (2, 0.4)) for method in ("default", "paper")]
        lines += [made.line(seed=seed) for seed in range(3)]
        lines += [made.line(suite="curves", case_name="curve-soybean-length", setting=setting)
                  for setting in (2, 5)]
        lines += [made.line(suite="inliers", method="paper", matches=10, matches_right=4,
                            matches_coherent=5)]
        table = read(lines)
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            report.write(table, Path(one), "Fields & <rows>")
            report.write(table, Path(two), "Fields & <rows>")
            names = sorted(path.name for path in Path(one).iterdir())
            for name in ("success-translation.svg", "accuracy-methods.svg", "breaking.svg",
                         "reliability.svg", "coverage.svg", "inliers.csv", "cases.csv"):
                self.assertIn(name, names)
            for name in names:
                if not name.endswith((".html", ".md")):
                    self.assertEqual((Path(one) / name).read_bytes(),
                                     (Path(two) / name).read_bytes(), name)
                if name.endswith(".svg"):
                    ElementTree.parse(Path(one) / name)
            page = (Path(one) / "index.html").read_text()
            self.assertIn("Fields &amp; &lt;rows&gt;", page)

    def test_a_document_gets_its_tables(self):
        text = ("a\n<!-- analyse: here/x -->\nold\n<!-- end -->\n"
                "<!-- analyse: there/x -->\n<!-- end -->")
        made_anew = report.update_document(text, "here", {"x": "| new |\n"})
        self.assertIn("<!-- analyse: here/x -->\n| new |\n<!-- end -->", made_anew)
        self.assertIn("<!-- analyse: there/x -->\n<!-- end -->", made_anew)
        for folder, tables in (("here", {"y": ""}), ("elsewhere", {"x": ""})):
            with self.assertRaises(report.DocumentError):
                report.update_document(text, folder, tables)

    def test_documents_have_the_tables_of_their_rows(self):
        for document in sorted(DOCUMENTS.glob("*.md")):
            text = document.read_text(encoding="utf-8")
            for folder in sorted(set(re.findall(r"<!-- analyse: ([\w-]+)/", text))):
                with self.subTest(document=document.name, folder=folder):
                    table = rows.read([RESULTS / folder / "rows.csv"])
                    shown = report.tables_of(report.sections(table))
                    self.assertEqual(report.update_document(text, folder, shown), text)


if __name__ == "__main__":
    unittest.main()
