#!/usr/bin/python3
"""Prints the last lines of scripts/test: tests that were skipped and why, tests that failed, then "N passed, N failed".

A failed test has its name and the first lines of what it found wrong, each line after "failed: ", so that a reader of the
end of a long log need not look for it.

Counts the cases of ctest. A rostest counts as the cases inside it, which it wrote to RESULTS/<name>; a rostest that wrote
none counts as one failed case. Exit status 1 if a case failed or none ran.
"""
import argparse
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree


LINES = 8  # of what a failed test found wrong


def complaint(output):
    """The lines of a test's output in which it says what is wrong: from the first that names a failure, else the last ones."""
    lines = [line for line in output.splitlines() if line.strip()]
    named = (at for at, line in enumerate(lines) if re.search(r": Failure|AssertionError|^(FAIL|ERROR)\b|\bError: ", line))
    first = next(named, max(len(lines) - LINES, 0))
    return lines[first:first + LINES]


def inner_cases(folder):
    """(passed, failed, complaints): numbers of the gtest cases inside a rostest, and what the failed ones say."""
    passed = failed = 0
    complaints = []
    for file in sorted(folder.rglob("rosunit-*.xml")):
        for case in ElementTree.parse(file).getroot().iter("testcase"):
            found = [child for child in case if child.tag in ("failure", "error")]
            passed, failed = passed + (not found), failed + bool(found)
            if found:
                text = (found[0].get("message") or "") + "\n" + (found[0].text or "")
                complaints += [f"{case.get('classname')}.{case.get('name')}"] + complaint(text)
    return passed, failed, complaints


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
    complaints = []
    for case in ElementTree.parse(junit).getroot().iter("testcase"):
        skip = case.find("skipped")
        if skip is not None and "SKIP_" in skip.get("message", ""):  # skipped by the test itself; otherwise ctest could not run it
            print(f"{case.get('name')}: SKIPPED: this system forbids what it needs (root)")
            continue
        if case.get("status") == "disabled":  # by its name: a measurement that is run by hand
            print(f"{case.get('name')}: not run, it is disabled")
            continue
        good = case.get("status") == "run"
        name = case.get("name")
        inner = inner_cases(results / name[4:]) if name.startswith("ros.") else (0, 0, [])
        if good:
            passed += max(inner[0], 1)
        else:
            passed, failed = passed + inner[0], failed + max(inner[1], 1)
            complaints += [name] + (inner[2] or complaint(case.findtext("system-out") or case.get("status")))
    for line in skipped(results):
        print(line)
    for line in complaints:
        print(f"failed: {line}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


sys.exit(main())
