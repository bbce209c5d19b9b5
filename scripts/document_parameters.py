#!/usr/bin/python3
"""Writes the parameter tables of a page (docs/nodes.md) from the launch files.

A table stands between `<!-- parameters: launch/NAME.launch -->` and `<!-- end -->`. Each row is an <arg> of the launch
file with its default and doc.
"""
import argparse
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

BLOCK = re.compile(r"(<!-- parameters: (\S+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def table(launch):
    rows = ["| argument | default | meaning |", "|---|---|---|"]
    for arg in ElementTree.parse(launch).getroot().findall("arg"):
        if "doc" in arg.attrib:
            default = f"`{arg.attrib['default']}`" if arg.attrib.get("default") else ("(empty)" if "default" in arg.attrib else "(required)")
            rows.append(f"| `{arg.attrib['name']}` | {default} | {arg.attrib['doc'].replace('|', '/')} |")
    return "\n".join(rows) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="change nothing; exit status 1 if a table is out of date")
    parser.add_argument("page", metavar="PAGE.md", type=pathlib.Path)
    arguments = parser.parse_args()
    check, page = arguments.check, arguments.page
    package = pathlib.Path(__file__).resolve().parent.parent
    old = page.read_text()
    new = BLOCK.sub(lambda match: match[1] + table(package / match[2]) + match[4], old)
    if check and new != old:
        print(f"{page}: parameter tables are out of date; run scripts/document_parameters.py {page}", file=sys.stderr)
        return 1
    if not check:
        page.write_text(new)
    return 0


sys.exit(main())
