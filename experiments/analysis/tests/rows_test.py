import re
import tempfile
import unittest
from pathlib import Path

from analysis import rows
from analysis.tests import RESULTS, made

ROW_HPP = Path(rows.__file__).parents[1] / "runner" / "row.hpp"


class RowsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "rows.csv"

    def fails(self, *words):
        with self.assertRaises(rows.RowError) as caught:
            rows.read([self.path])
        for word in (str(self.path), *words):
            self.assertIn(word, str(caught.exception))

    def test_reads_what_there_is_and_leaves_empty_what_is_not(self):
        made.write(self.path, [
            made.line(), made.line(seed=8, accepted=0, status="rejected", rms="")])
        read = rows.read([self.path])
        self.assertEqual(list(read.success), [True, False])
        self.assertEqual(read.rms[0], 0.02)
        self.assertTrue(read.rms.isna()[1])
        self.assertEqual(read.seed.tolist(), [7, 8])

    def test_columns_are_those_of_the_runner(self):
        if not ROW_HPP.exists():
            self.skipTest(f"{ROW_HPP} is missing")
        body = ROW_HPP.read_text().split("struct Row {")[1].split("success() const")[0]
        names = re.findall(r"^\s+(?:std::string|int|double|bool) (\w+)", body, re.MULTILINE)
        self.assertEqual(sorted(names), sorted(rows.COLUMNS))

    def test_rows_of_earlier_sources_have_more_columns(self):
        made.write(self.path, [made.line() + ",0,2.5,137,40,0.9"],
                   header=[*rows.COLUMNS, *rows.EARLIER])
        self.assertEqual(rows.read([self.path]).peak_mib.tolist(), [137])
        made.write(self.path, [made.line()])
        self.assertTrue(rows.read([self.path]).peak_mib.isna().all())

    def test_other_columns_are_named(self):
        made.write(self.path, [], header=[*rows.COLUMNS[1:], "colour"])
        self.fails("rows.csv:1:", "missing: suite", "unknown: colour")

    def test_a_bad_field_is_named_with_its_line(self):
        for column, text in (("rms", "two"), ("seed", "1.5"), ("seed", ""), ("accepted", "yes"),
                             ("status", "lost"), ("run_s", "inf")):
            with self.subTest(column=column, text=text):
                made.write(self.path, [made.line(), made.line(**{"seed": 8, column: text})])
                self.fails("rows.csv:3:", column)

    def test_a_line_of_another_length_is_named(self):
        made.write(self.path, [made.line(), made.line(seed=8) + ",more"])
        self.fails("rows.csv:3:", f"has {len(rows.COLUMNS) + 1} fields")

    def test_a_run_that_is_there_twice_is_named(self):
        made.write(self.path, [made.line(), made.line(seed=8), made.line()])
        self.fails("rows.csv:4:", "rows.csv:2", "seed 7")

    def test_a_last_line_that_was_cut_off_is_left_out(self):
        made.write(self.path, [made.line()])
        with self.path.open("a") as file:
            file.write(made.line(seed=8)[:50])
        self.assertEqual(len(rows.read([self.path])), 1)

    def test_files_that_are_no_tables_are_named(self):
        self.path.write_text("")
        self.fails("is empty")
        self.path.write_bytes(b"\xff\xfe\x00")
        self.fails("cannot be read")
        self.path.unlink()
        self.fails("cannot be read")

    def test_committed_rows_can_be_read(self):
        files = sorted(RESULTS.glob("*/rows.csv"))
        self.assertGreaterEqual(len(files), 5)
        for file in files:
            with self.subTest(file=file):
                self.assertGreater(len(rows.read([file])), 0)


if __name__ == "__main__":
    unittest.main()
