"""Usage: public_headers.py INCLUDE_DIRECTORY PAGE. Checks the headers installed in INCLUDE_DIRECTORY/fsr_pressure_map.
Each may include only other installed headers, by their full names, and headers of the C and C++ standard libraries.
The table in section "Public headers" of PAGE lists them all, but for the ROS room, which the core does not install."""
import pathlib
import re
import sys

# <vector>, <cstdint>: standard names without a folder; and C headers, for a header that firmware compiles, too.
STANDARD = re.compile(r"^([a-z_0-9]+|(stddef|stdint|string|limits|math)\.h)$")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.MULTILINE)


def foreign_includes(include, headers):
    """One sentence for each include that a user of the installed library could not resolve."""
    for header in headers:
        for quote, name in INCLUDE.findall((include / header).read_text(encoding="utf-8")):
            installed = name.startswith("fsr_pressure_map/") and (include / name).is_file()
            if not installed and not (quote == "<" and STANDARD.match(name)):
                yield "%s includes %s, which is not a public header" % (header, name)


def listed_headers(page):
    """The headers in rows "| `room` | `a.h`, `b.h` | use |" of the page."""
    section = page.read_text(encoding="utf-8").split("## Public headers", 1)[1].split("\n## ", 1)[0]
    listed = set()
    for room, names in re.findall(r"^\| `(\w+)` \|([^|]*)\|", section, re.MULTILINE):
        listed |= {"fsr_pressure_map/%s/%s" % (room, name) for name in re.findall(r"`([^`]+)`", names)}
    return {name for name in listed if not name.startswith("fsr_pressure_map/ros/")}


def complaints(include, page):
    """One sentence for each defect."""
    headers = {str(path.relative_to(include)) for path in (include / "fsr_pressure_map").rglob("*.h")}
    if not headers:
        yield "%s: there are no installed headers" % include
    yield from foreign_includes(include, sorted(headers))
    listed = listed_headers(page)
    for name in sorted(headers - listed):
        yield "%s is installed, but is not in the table of public headers in %s" % (name, page.name)
    for name in sorted(listed - headers):
        yield "%s is in the table of public headers in %s, but is not installed" % (name, page.name)


def main():
    found = list(complaints(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
    for sentence in found:
        print(sentence, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
