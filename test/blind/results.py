"""Scores many cases at once and writes the results; scripts/score_cases and scripts/blind_trials share it."""

import concurrent.futures
import json
import pathlib
import sys
import time

import cases
import summary


def found_of(case, options):
    return pathlib.Path(options.verdicts, case.name) if options.verdicts else case / "found"


def score_one(case, options):
    """(row or None, problem or None) of one case; asks the command first where the case has no answer."""
    found = found_of(case, options)
    try:
        cases.read_key(case)  # nothing is run for a case that cannot be scored
        if not options.verdicts and not cases.answered(found):
            cases.answer(case, found, options.command)
        version = None if options.any_version else cases.package_version()
        return cases.score_folder(case, found, version, None if options.no_gap else options.simulate)
    except cases.NotScored as why:
        return None, why
    except OSError as error:
        return None, cases.NotScored("file error", "%s: %s." % (case, error))


def report(case, problem, problems):
    text = str(problem)
    sentence = text if str(case) in text or case.name in text else "%s: %s" % (case, text)
    problems.append({"case": case.name, "category": problem.category, "sentence": sentence})
    print(sentence, file=sys.stderr, flush=True)


class Progress:
    """A line on stderr that is written over on a terminal; elsewhere a line now and then."""

    def __init__(self, number, what="cases"):
        self.number, self.what, self.start, self.said = number, what, time.monotonic(), 0

    def show(self, done):
        now = time.monotonic()
        terminal = sys.stderr.isatty()
        if not terminal and done < self.number and now - self.said < 30:
            return
        self.said = now
        left = (now - self.start) / done * (self.number - done) / 60
        text = "%d of %d %s, about %d min left" % (done, self.number, self.what, round(left))
        end = "\r" if terminal and done < self.number else "\n"
        print(text.ljust(60) if terminal else text, end=end, file=sys.stderr, flush=True)


def score_all(folders, options):
    """Rows in the order of the folders, and the problems."""
    rows, problems, progress = {}, [], Progress(len(folders))
    with concurrent.futures.ThreadPoolExecutor(max_workers=max(1, options.jobs)) as pool:
        futures = {pool.submit(score_one, case, options): case for case in folders}
        try:
            for done, future in enumerate(concurrent.futures.as_completed(futures), 1):
                case, (row, problem) = futures[future], future.result()
                if row:
                    rows[case] = row
                if problem:
                    report(case, problem, problems)
                progress.show(done)
        except KeyboardInterrupt:
            print("\nwaiting for the cases that run", file=sys.stderr)
            for future in futures:
                future.cancel()
            sys.exit("stopped; the same command goes on from here")
    return [rows[case] for case in folders if case in rows], sorted(problems, key=lambda p: p["case"])


def write_results(rows, problems, folder, shard):
    stem = "_%d_of_%d" % shard if shard else ""
    data = summary.summarise(rows, problems)
    text = summary.markdown(data)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / ("summary%s.json" % stem)).write_text(json.dumps(dict(data, problems=problems), indent=1) + "\n")
    (folder / ("summary%s.md" % stem)).write_text(text)
    (folder / ("cases%s.csv" % stem)).write_text(summary.csv_text(rows))
    print(text)
