#!/usr/bin/python3
"""ros2_messages.py ROOT: checks that ROS 2 accepts every message and service as it is, with ROS 2's own parser (rosidl_adapter, Debian
package python3-rosidl). It refuses, among others, field names that are not lower_snake_case, constants that are not UPPER_CASE, the
types time and duration, and Header without its package. Prints each refusal; exit status 1 if there is one, 77 without the parser.
"""
import pathlib
import sys

try:
    from rosidl_adapter.parser import InvalidSpecification, parse_message_file, parse_service_file
except ImportError:
    print("SKIPPED: ROS 2's parser is not installed (Debian package python3-rosidl)")
    sys.exit(77)

NO_MORE = {"time", "duration", "char", "byte"}  # primitives of ROS 1 that ROS 2 lacks or understands differently


def refusals(root):
    """One sentence for each file that a ROS 2 package could not take over unchanged."""
    files = [*sorted((root / "msg").glob("*.msg")), *sorted((root / "srv").glob("*.srv"))]
    if not files:
        yield f"{root}: has no msg/*.msg and srv/*.srv"
    for file in files:
        parse = parse_message_file if file.suffix == ".msg" else parse_service_file
        try:
            parse("fsr_pressure_map", str(file))
        except (InvalidSpecification, NameError, TypeError, ValueError) as error:
            yield f"{file.name}: ROS 2 refuses it: {' '.join(str(error).split()) or type(error).__name__}"
        for line in file.read_text(encoding="utf-8").splitlines():
            kind = line.split("#")[0].split("[")[0].split()
            if kind and kind[0] in NO_MORE | {"Header"}:
                yield f'{file.name}: "{line.split("#")[0].strip()}" means something else in ROS 2; write the type with its package'


def main():
    found = list(refusals(pathlib.Path(sys.argv[1])))
    for sentence in found:
        print(sentence)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
