#!/usr/bin/python3
"""Holds scripts/count_tests.py against results of ctest and of rostests that were written here."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts/count_tests.py"


class CountTests(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = pathlib.Path(folder.name)

    def count(self, cases):
        """(exit status, lines) of the script for the given <testcase> elements of ctest."""
        junit = self.results / "ctest.xml"
        junit.write_text(f"<testsuite>{cases}</testsuite>")
        done = subprocess.run(["/usr/bin/python3", "-B", SCRIPT, junit, self.results], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()

    def test_counts_what_passed(self):
        self.assertEqual(self.count('<testcase name="A.B" status="run"/><testcase name="A.C" status="run"/>'), (0, ["2 passed, 0 failed"]))

    def test_a_disabled_case_is_named_and_not_counted(self):
        self.assertEqual(self.count('<testcase name="A.B" status="run"/><testcase name="A.D" status="disabled"/>'),
                         (0, ["A.D: not run, it is disabled", "1 passed, 0 failed"]))

    def test_names_what_failed_and_quotes_it_from_its_first_failure(self):
        output = "noise\nx_test.cpp:3: Failure\nExpected equality\n"
        self.assertEqual(self.count(f'<testcase name="A.B" status="fail"><system-out>{output}</system-out></testcase>'),
                         (1, ["failed: A.B", "failed: x_test.cpp:3: Failure", "failed: Expected equality", "0 passed, 1 failed"]))

    def test_quotes_the_last_lines_where_no_failure_is_named(self):
        output = "\n".join(f"line {number}" for number in range(20))
        status, lines = self.count(f'<testcase name="A.B" status="fail"><system-out>{output}</system-out></testcase>')
        self.assertEqual((status, lines[1], lines[-2]), (1, "failed: line 12", "failed: line 19"))

    def test_counts_and_names_the_cases_of_a_rostest(self):
        folder = self.results / "day"
        folder.mkdir()
        (folder / "rosunit-day.xml").write_text('<testsuite><testcase classname="day.Day" name="good"/><testcase classname="day.Day" '
                                                'name="bad"><failure message="AssertionError: no report"/></testcase></testsuite>')
        self.assertEqual(self.count('<testcase name="ros.day" status="fail"/>'),
                         (1, ["failed: ros.day", "failed: day.Day.bad", "failed: AssertionError: no report", "1 passed, 1 failed"]))

    def test_a_rostest_without_results_is_one_failed_case(self):
        self.assertEqual(self.count('<testcase name="ros.day" status="fail"/>')[1][-1], "0 passed, 1 failed")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
