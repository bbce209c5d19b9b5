#!/usr/bin/python3
"""versions.py ROOT [PACKAGE.deb...]: checks that everything that repeats the version of package.xml agrees with it: CITATION.cff, the
first section of CHANGELOG.rst, and the Debian packages. CMakeLists.txt reads package.xml and may state no version of its own. Prints
each difference; exit status 1 if there is one.
"""
import pathlib
import re
import subprocess
import sys


def stated(path, pattern):
    """What the first match of the pattern in a file says; "no version" = nothing matches."""
    match = re.search(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
    return match.group(1) if match else "no version"


def differences(root, packages):
    """One sentence for each place that names another version than package.xml."""
    version = stated(root / "package.xml", r"<version>([^<]*)</version>")
    if not re.fullmatch(r"[0-9]+\.[0-9]+\.[0-9]+", version):
        yield f"package.xml: version is {version}; it would be right as three numbers, e.g. 1.2.3"
    places = {
        "CITATION.cff": stated(root / "CITATION.cff", r"^version: (\S+)$"),
        "CHANGELOG.rst, first section": stated(root / "CHANGELOG.rst", r"^(\S+) \((?:forthcoming|\d{4}-\d\d-\d\d)\)\n-+$"),
    }
    for package in packages:
        field = subprocess.run(["dpkg-deb", "--field", package, "Version"], check=True, stdout=subprocess.PIPE, text=True)
        places[pathlib.Path(package).name] = field.stdout.strip()
    for place, found in places.items():
        if found != version:
            yield f"{place}: names {found}; package.xml names {version}"
    own = stated(root / "CMakeLists.txt", r"^project\([^)]*VERSION ([0-9][^ )]*)")
    if own != "no version":
        yield f"CMakeLists.txt: project() states version {own}; it should take that of package.xml"


def main():
    found = list(differences(pathlib.Path(sys.argv[1]), sys.argv[2:]))
    for sentence in found:
        print(sentence)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
