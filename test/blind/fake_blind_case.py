#!/usr/bin/python3
"""Stands for the generator in tests of scripts/blind_trials: --name NAME --effect ID:FORM[,...] --output CASE | --list |
--classes.

The bags hold no scans. A repositioning cannot show, so it is refused as the generator does.
"""

import argparse
import json
import pathlib
import sys

LIST = ["creep:log_time:A", "creep:two_terms:A", "seal_leak:orifice:A", "repositioning:tilt:A", "creep:sealed:B"]


def key(options):
    effects = [dict(zip(("id", "form"), text.split(":"))) for text in options.effect.split(",") if text != "none"]
    for effect in effects:
        effect.update(snr=float(options.snr or 1), kpa_at_map=float(options.kpa or 10), depends_on=[], parameters=[])
    told = [{"id": effect["id"], "could_be_told": True} for effect in effects]
    return {"schema": 2, "case": options.name, "truth": "named" if effects else "none", "set": options.name[0],
            "protocol_class": "regular" if "1" in options.name[-1] else "dwells", "effects": effects,
            "identifiable": {"effects": told}, "sheet": {"rows": 3, "columns": 4}}


def main():
    parser = argparse.ArgumentParser()
    for name in ("name", "effect", "snr", "kpa", "size", "output"):
        parser.add_argument("--" + name)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--classes", action="store_true")
    options = parser.parse_args()
    if options.list:
        print("\n".join(LIST))
        return 0
    if options.classes:
        print("regular\ndwells\nshort")
        return 0
    if "repositioning" in options.effect:
        print("blind_case: no surface is mounted twice", file=sys.stderr)
        return 2
    bags = pathlib.Path(options.output, "bags")
    bags.mkdir(parents=True)
    (bags / "1_flat.bag").write_text("no scans")
    pathlib.Path(options.output, "key.yaml").write_text(json.dumps(key(options)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
