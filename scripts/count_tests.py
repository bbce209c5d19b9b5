#!/usr/bin/python3
"""Prints the last lines of scripts/test: which tests were skipped and why, then "N passed, N failed".

Counts the cases of ctest. A rostest counts as the cases inside it, which it wrote to RESULTS/<name>; a rostest that wrote
none counts as one failed case. Exit status 1 if a case failed or none ran.
"""
import argparse
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree


def inner_cases(folder):
    """(passed, failed): numbers of the gtest cases inside a rostest."""
    passed = failed = 0
    for file in folder.rglob("rosunit-*.xml"):
        for case in ElementTree.parse(file).getroot().iter("testcase"):
            bad = case.find("failure") is not None or case.find("error") is not None
            passed, failed = passed + (not bad), failed + bad
    return passed, failed


def skipped(results):
    """Lines in which rostests report skipped cases. ctest reports the others itself."""
    for file in sorted(results.rglob("rosunit-*.xml")):
        for why in re.findall("SKIPPED: .*", file.read_text(errors="replace")):
            yield f"{file.relative_to(results).parts[0]}: {why}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("junit", metavar="JUNIT", help="file that ctest --output-junit wrote")
    parser.add_argument("results", metavar="RESULTS", type=pathlib.Path, help="folder of the results of rostests")
    arguments = parser.parse_args()
    junit, results = arguments.junit, arguments.results
    passed = failed = 0
    for case in ElementTree.parse(junit).getroot().iter("testcase"):
        skip = case.find("skipped")
        if skip is not None and "SKIP_" in skip.get("message", ""):  # skipped by the test itself; otherwise ctest could not run it
            print(f"{case.get('name')}: SKIPPED: this system forbids what it needs (root)")
            continue
        good = case.get("status") == "run"
        name = case.get("name")
        inner = inner_cases(results / name[4:]) if name.startswith("ros.") else (0, 0)
        if good:
            passed += max(inner[0], 1)
        else:
            passed, failed = passed + inner[0], failed + max(inner[1], 1)
    for line in skipped(results):
        print(line)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


sys.exit(main())
