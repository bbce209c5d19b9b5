"""Folders of cases: reads and checks them, runs the command under test on them, and scores what it says.

    CASE/bags/*.bag   CASE/key.yaml   and, once it was answered, CASE/found/verdict.yaml (see docs/cases.md)
"""

import hashlib
import itertools
import json
import os
import pathlib
import re
import shlex
import shutil
import tempfile
import time

import yaml

import recompute
import score

HERE = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = {"problem": None}  # a gap that nobody asked for
UNUSABLE = 2  # exit status of a command that refuses its input with one sentence


class Refused(Exception):
    """The command's sentence."""


class NotScored(Exception):
    """A case that cannot be scored: category for the count, and one sentence."""

    def __init__(self, category, sentence):
        super().__init__(sentence)
        self.category = category


def executable(name):
    folders = [os.environ.get("FSR_BUILD_DIR"), HERE / "out", HERE / "build"]
    built = [pathlib.Path(f, "devel/lib/fsr_pressure_map", name) for f in folders if f]
    return next((shlex.quote(str(path)) for path in built if path.exists()), "rosrun fsr_pressure_map " + name)


def package_version():
    return re.search(r"<version>(.*?)</version>", (HERE / "package.xml").read_text())[1]


def shard_of(text):
    """(I, N) of "I/N", 1 <= I <= N."""
    match = re.fullmatch(r"(\d+)/(\d+)", text)
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise ValueError("%s is no shard; write I/N with 1 <= I <= N, e.g. 2/4" % text)
    return int(match[1]), int(match[2])


def in_shard(items, shard):
    return items[shard[0] - 1::shard[1]] if shard else items


def find_cases(folder):
    """Folders that hold a case, or a part of one."""
    return sorted(f for f in pathlib.Path(folder).iterdir() if (f / "bags").is_dir() or (f / "key.yaml").exists())


# --- files of a case --------------------------------------------------------------------------------


def load(path, what):
    try:
        data = yaml.load(path.read_text(), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = str(error).splitlines()[0]
        raise NotScored(what + " cannot be read", "%s cannot be read (%s)." % (path, reason)) from error
    if not isinstance(data, dict):
        raise NotScored(what + " cannot be read", "%s must be a mapping." % path)
    return data


def read_key(case):
    path = case / "key.yaml"
    if not path.exists():
        raise NotScored("no key", "%s has no key.yaml." % case)
    key = load(path, "key")
    if key.get("schema") != score.SCHEMA:
        found = "no schema" if key.get("schema") is None else "schema %s" % key["schema"]
        raise NotScored("key of another schema", "%s has %s, but must have schema %d." % (path, found, score.SCHEMA))
    for field, kind in (("truth", str), ("effects", list)):
        if not isinstance(key.get(field), kind):
            raise NotScored("key cannot be read", "%s must hold a %s `%s`." % (path, kind.__name__, field))
    return key


def read_verdict(found, version):
    """`version` is the one that must be in it; None = any."""
    path = found / "verdict.yaml"
    if not path.exists():
        raise NotScored("no verdict", "%s is missing." % path)
    verdict = load(path, "verdict")
    if version and verdict.get("version") != version:
        raise NotScored("verdict of another version", "%s is of version %s, but must be of version %s." % (
            path, verdict.get("version"), version))
    return verdict


def in_order(bag):
    number = re.match(r"\d+", bag.name)
    return (int(number[0]) if number else 0, bag.name)


def bags_of(case):
    return sorted((case / "bags").glob("*.bag"), key=in_order)


def read_json(path):
    """What a file holds that these scripts wrote; {} where there is none, or half of one."""
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return {}


def generator_words(name):
    """What the generator is told of a case, read off its name."""
    match = re.fullmatch(r"[AB]\.(none|[a-z0-9_.+]+?)(?:\.(snr|kpa)([0-9.e+-]+?))?\.\d+", name)
    if not match:
        raise ValueError("%s is no name of a case; names are like A.hysteresis.duhem.snr1.0007" % name)
    effects, kind, size = match.groups()
    words = ["--name", name, "--effect", effects.replace(".", ":").replace("+", ",")]
    return words + (["--" + kind, size] if kind else [])


# --- the command under test -------------------------------------------------------------------------


def environment(home):
    """Each case has its own ROS_HOME, where looks at hold-out data are counted. ROS_PACKAGE_PATH: config/ is found without
    a sourced workspace."""
    return {"PATH": "/usr/bin:/bin", "ROS_PACKAGE_PATH": str(HERE), **os.environ, "ROS_HOME": str(home)}


def without_name(case, bags, folder):
    """Links to the bags in a folder whose name says nothing about the case."""
    links = folder / hashlib.sha256(case.name.encode()).hexdigest()[:12]
    links.mkdir(parents=True)
    for bag in bags:
        (links / bag.name).symlink_to(bag.resolve())
    return [links / bag.name for bag in bags]


def run_command(command, bags, output, home):
    """Runs the command under test on bags. Returns its time [s]."""
    filled = shlex.split(command.replace("{output}", shlex.quote(str(output))))
    words = list(itertools.chain.from_iterable(map(str, bags) if word == "{bags}" else [word] for word in filled))
    start = time.monotonic()
    try:
        done = recompute.run_program(words, env=environment(home))
    except OSError as error:
        raise NotScored("command failed", "%s cannot be started (%s)." % (words[0], error.strerror)) from error
    said = (done.stderr.strip() or done.stdout.strip()).splitlines()[-1:] or ["it said nothing"]
    if done.returncode == UNUSABLE:
        raise Refused(said[0])
    if done.returncode not in (0, 3):  # 3: all but the figures
        raise NotScored("command failed", "the command ended with status %d (%s)." % (done.returncode, said[0]))
    return time.monotonic() - start


def answered(found):
    return (found / "verdict.yaml").exists() or (found / "refused.json").exists()


def answer(case, found, command):
    """Runs the command on the bags of a case; what it writes goes to `found`. A refusal is an answer, too."""
    bags = bags_of(case)
    if not bags:
        raise NotScored("bags missing", "%s holds no bag." % (case / "bags"))
    with tempfile.TemporaryDirectory(prefix="case_") as folder:
        folder = pathlib.Path(folder)
        output = folder / "found"
        try:
            seconds = run_command(command, without_name(case, bags, folder), output, folder / "ros_home")
            if not (output / "verdict.yaml").exists():
                raise NotScored("no verdict", "the command wrote no verdict.yaml for %s." % case)
            recompute.write_json(output / "run.json", {"seconds": seconds, "command": command})
        except Refused as why:
            shutil.rmtree(output, ignore_errors=True)
            output.mkdir()
            recompute.write_json(output / "refused.json", {"sentence": str(why), "command": command})
        copy = found.with_name(found.name + ".new")  # so that `found` is never half an answer
        for old in (copy, found):
            shutil.rmtree(old, ignore_errors=True)
        shutil.copytree(output, copy)
        copy.replace(found)


# --- the gap ----------------------------------------------------------------------------------------


def recomputed_gap(case, found, verdict, simulate):
    """The recomputed gap; kept in recomputed.json with the hash of the verdict that it belongs to."""
    path, digest = found / "recomputed.json", hashlib.sha256((found / "verdict.yaml").read_bytes()).hexdigest()
    kept = read_json(path)
    if kept.get("verdict_sha256") == digest:
        return kept
    bags = bags_of(case)
    if not bags:
        raise NotScored("bags missing", "%s holds no bag, so its gap is not recomputed." % (case / "bags"))
    with tempfile.TemporaryDirectory(prefix="gap_") as folder:
        folder = pathlib.Path(folder)
        gap = recompute.recompute(shlex.split(simulate), bags, verdict, found, folder, environment(folder / "ros_home"))
    gap["verdict_sha256"] = digest
    try:
        recompute.write_json(path, gap)
    except OSError:
        pass  # a folder that may not be written to: it is computed again next time
    return gap


# --- one case ---------------------------------------------------------------------------------------


def score_folder(case, found, version, simulate):
    """(row, problem): the score of an answered case, and why its gap is missing. `simulate` None: no gap is recomputed."""
    refused = not (found / "verdict.yaml").exists() and (found / "refused.json").exists()
    key, problem = read_key(case), None
    verdict = score.REFUSED if refused else read_verdict(found, version)
    try:
        row = score.score_case(key, verdict, case.name)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        said = "%s is missing" % error if isinstance(error, KeyError) else str(error)
        raise NotScored("key or verdict not as documented", "%s: %s." % (case, said)) from error
    try:
        gap = recomputed_gap(case, found, verdict, simulate) if simulate and not refused else SKIPPED
    except NotScored as why:
        gap, problem = {"problem": why.category}, why
    score.add_gap(row, gap)
    row["seconds"] = read_json(found / "run.json").get("seconds")
    row["refused_because"] = read_json(found / "refused.json").get("sentence") if refused else None
    return row, problem
