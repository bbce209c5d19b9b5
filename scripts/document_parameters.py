#!/usr/bin/python3
"""Writes the parameter tables of a page (docs/nodes.md) from the launch files.

A table stands between `<!-- parameters: launch/NAME.launch -->` and `<!-- end -->`. Each row is an <arg> of the launch
file with its default and doc. What several launch files have alike stands once, between `<!-- parameters: shared -->`
and `<!-- end -->`; below a table of one launch file there are the names of the shared ones that it takes.
"""
import argparse
import collections
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

LAUNCH = pathlib.Path(__file__).resolve().parent.parent / "launch"
BLOCK = re.compile(r"(<!-- parameters: (?:launch/)?(\S+?)(?:\.launch)? -->\n)(.*?)(<!-- end -->)", re.DOTALL)
HEAD = "| argument and default | meaning |\n|---|---|\n"


def arguments(launch):
    """[(name, default, meaning)] of a launch file; default None = required"""
    found = ElementTree.parse(launch).getroot().findall("arg")
    return [(arg.get("name"), arg.get("default"), arg.get("doc").replace("|", "/")) for arg in found if "doc" in arg.attrib]


def row(argument):
    name, default, meaning = argument
    return f"| `{name}` (required) | {meaning} |\n" if default is None else f"| `{name}:={default}` | {meaning} |\n"


def tables():
    """The text of each block by its name: shared, or the stem of a launch file"""
    of = {path.stem: arguments(path) for path in sorted(LAUNCH.glob("*.launch"))}
    times = collections.Counter(argument for found in of.values() for argument in found)
    text = {"shared": HEAD + "".join(row(argument) for argument in sorted(times, key=lambda a: (a[0], a[2])) if times[argument] > 1)}
    for name, found in of.items():
        own = "".join(row(argument) for argument in found if times[argument] == 1)
        shared = ", ".join(f"`{argument[0]}`" for argument in found if times[argument] > 1)
        text[name] = (HEAD + own + "\n" if own else "") + f"[Shared](#shared-arguments): {shared}.\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="change nothing; exit status 1 if a table is out of date")
    parser.add_argument("page", metavar="PAGE.md", type=pathlib.Path)
    given = parser.parse_args()
    check, page = given.check, given.page
    old, text = page.read_text(), tables()
    new = BLOCK.sub(lambda match: match[1] + text[match[2]] + match[4], old)
    if check and new != old:
        print(f"{page}: parameter tables are out of date; run scripts/document_parameters.py {page}", file=sys.stderr)
        return 1
    if not check:
        page.write_text(new)
    return 0


sys.exit(main())
