#!/usr/bin/python3
"""sanitizer_reports.py FILE...: prints those reports of a sanitizer that concern the package's own code.

All but data races do. ROS is not built with the thread sanitizer, which therefore does not see in what order ROS's threads
release a message or a connection: a race counts where both of its accesses were made by the package's code, by itself or
through a header or a function of the C library, and not by a library of others that it had called or that called a header of
its own. Status 1 where one was printed.
"""
import re
import sys

FRAME = re.compile(r"^    #\d+ (?P<what>.*) \((?P<module>[^()]*)\+0x[0-9a-f]+\)(?: \(BuildId: \w+\))?$")
SUM = re.compile(r"ThreadSanitizer: reported \d+ warnings$")  # at the end of the process
OURS = re.compile(r"/(src|test)/\w+/|/include/fsr_pressure_map/\w+/\w+\.h:")  # not the generated messages


def made_by_us(stack):
    for line in stack:
        frame = FRAME.match(line)
        if not frame:
            continue
        if OURS.search(frame["what"]):
            return True
        if "<null>" in frame["what"] and ".so" in frame["module"]:
            return False  # otherwise a function of the sanitizer, which is in the executable, or of a header
    return False


def accesses(report):
    """The stacks of the two accesses of a race: the first two paragraphs."""
    paragraphs = report.split("\n\n")
    return [paragraph.splitlines() for paragraph in paragraphs[:2]]


def counts(report):
    if not report.strip() or SUM.match(report):
        return False
    return "ThreadSanitizer: data race" not in report or all(made_by_us(stack) for stack in accesses(report))


def main():
    found = []
    for path in sys.argv[1:]:
        with open(path, errors="replace") as file:
            text = file.read()
        found += [report for report in re.split(r"(?m)^=+\n", text) if counts(report)]
    print("\n".join(found[:3]), end="")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
