"""The file that a shard of a campaign writes, and the check that the files of all shards belong together.

    DIR/shard_2_of_4.json    version, shard, options of the campaign with their hash, cases and what became of each

A shard writes it when it ends, so a shard that was killed has none. Shards of other machines are merged by copying their folders
into one; merge() refuses what does not belong together with one sentence that names the file.
"""

import hashlib
import json
import pathlib

import cases
import recompute

OPEN = (None, "left")  # statuses of a case that was not begun, or was stopped


class Unfit(Exception):
    """Why the shards cannot be merged: one sentence."""


def digest(options):
    return hashlib.sha256(json.dumps(options, sort_keys=True).encode()).hexdigest()


def path_of(folder, shard):
    return pathlib.Path(folder, "shard_%d_of_%d.json" % shard)


def write(folder, shard, campaign, statuses):
    """`campaign`: its options; `statuses`: {case: status of its run.json, or "left"}. Written in one step."""
    path = path_of(folder, shard)
    path.parent.mkdir(parents=True, exist_ok=True)
    recompute.write_json(path, {"tool": "blind_trials", "version": cases.package_version(), "shard": shard[0], "of": shard[1],
                                "campaign": campaign, "campaign_sha256": digest(campaign), "cases": statuses})
    return path


def read(path):
    try:
        data = json.loads(path.read_text())
        good = (data["tool"] == "blind_trials" and 1 <= data["shard"] <= data["of"] and isinstance(data["version"], str)
                and isinstance(data["cases"], dict) and data["campaign_sha256"] == digest(data["campaign"]))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unfit("%s cannot be read as the file of a shard (%s); run this shard again" % (path, error)) from error
    if not good:
        raise Unfit("%s is not a shard of blind_trials as it was written; run this shard again" % path)
    return data


def difference(one, other):
    """Names the first option in which two campaigns differ."""
    name = next(name for name in sorted(set(one) | set(other)) if one.get(name) != other.get(name))
    return "--%s is %s here and %s there" % (name.replace("_", "-"), json.dumps(one.get(name)), json.dumps(other.get(name)))


def refuse_differences(found):
    (first_path, first), *others = found
    for path, data in others:
        for field, what in (("version", "version %s"), ("of", "a campaign of %s shards")):
            if data[field] != first[field]:
                raise Unfit("%s is of %s, but %s of %s; run all shards with the same" % (
                    path, what % data[field], first_path, what % first[field]))
        if data["campaign"] != first["campaign"]:
            raise Unfit("%s has other options than %s: %s" % (path, first_path, difference(data["campaign"], first["campaign"])))


def refuse_doubles(found):
    shards, names = {}, {}
    for path, data in found:
        if data["shard"] in shards:
            raise Unfit("%s and %s are both shard %d of %d; remove one of them" % (
                shards[data["shard"]], path, data["shard"], data["of"]))
        shards[data["shard"]] = path
        for name in data["cases"]:
            if name in names:
                raise Unfit("%s and %s both have the case %s; run both shards again" % (names[name], path, name))
            names[name] = path


def refuse_gaps(found, folder):
    number = found[0][1]["of"]
    missing = sorted(set(range(1, number + 1)) - {data["shard"] for _, data in found})
    if missing:
        text = "shard %d of %d is missing" % (missing[0], number)
        more = " (and %d more)" % (len(missing) - 1) if missing[1:] else ""
        raise Unfit("%s: %s%s; run it with --shard %d/%d" % (folder, text, more, missing[0], number))
    for path, data in found:
        left = [name for name, status in data["cases"].items() if status in OPEN]
        if left:
            raise Unfit("%s: %d of its cases are left, e.g. %s; the command of this shard goes on from here" % (path, len(left), left[0]))
        for name, status in data["cases"].items():
            run = cases.read_json(pathlib.Path(folder, "cases", name, "run.json"))
            if run.get("status") != status:
                raise Unfit("%s has the case %s as %s, but %s has it as %s; copy the folders of all shards into one" % (
                    path, name, status, pathlib.Path(folder, "cases", name), run.get("status", "missing")))


def merge(folder):
    """The campaign's options, and the names of all cases of all shards. Throws Unfit."""
    paths = sorted(pathlib.Path(folder).glob("shard_*.json"))
    if not paths:
        raise Unfit("%s has no shard_I_of_N.json; run the shards with --shard I/N first" % folder)
    found = [(path, read(path)) for path in paths]
    refuse_differences(found)
    refuse_doubles(found)
    refuse_gaps(found, folder)
    return found[0][1]["campaign"], sorted(name for _, data in found for name in data["cases"])
