#!/usr/bin/python3
"""links.py ROOT: checks that relative links, anchors and images in the package's Markdown pages resolve.

Looks at *.md in ROOT, docs and test. Links to other sites are not followed. Prints each broken link; exit status 1 if there is one.
"""
import pathlib
import re
import sys
import urllib.parse

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
SITE = re.compile(r"[a-z]+:")  # https:, mailto: ...
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")


def text_lines(page):
    """The lines of a page without its code blocks: fenced, or indented by four spaces after an empty line."""
    fenced, code, after_empty = False, False, True
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
        code = line.startswith("    ") and (code or after_empty)
        after_empty = not line.strip()
        if not fenced and not code:
            yield line


def anchors(page):
    """The anchors that GitHub gives the headings of a page."""
    found = set()
    for line in text_lines(page):
        match = HEADING.match(line)
        if not match:
            continue
        words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", match[1]).lower()
        slug = base = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        number = 0
        while slug in found:
            number += 1
            slug = f"{base}-{number}"
        found.add(slug)
    return found


def broken(page, target):
    """What is wrong with a link; empty = nothing."""
    path, _, anchor = urllib.parse.unquote(target).partition("#")
    other = page if not path else page.parent / path
    if not other.exists():
        return "there is no such file"
    if anchor and other.suffix == ".md" and anchor not in anchors(other):
        return "there is no such heading"
    return ""


def main():
    root = pathlib.Path(sys.argv[1])
    pages = sorted([*root.glob("*.md"), *root.glob("docs/**/*.md"), *root.glob("test/**/*.md")])
    links = failures = 0
    for page in pages:
        text = re.sub(r"`[^`\n]*`", "", "\n".join(text_lines(page)))
        for target in LINK.findall(text):
            if SITE.match(target):
                continue
            links += 1
            why = broken(page, target)
            if why:
                failures += 1
                print(f"{page.relative_to(root)}: {target}: {why}")
    print(f"{links} links in {len(pages)} pages, {failures} broken")
    return 1 if failures or not links else 0


sys.exit(main())
