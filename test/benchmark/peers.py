#!/usr/bin/python3
"""Compares the package with other packages and with its targets, in one run on the same data.

Prints the targets with the values reached, then every comparison. Packages that are not installed are left out:
python3-sklearn, python3-scipy, python3-opencv, r-cran-ranger (with r-base-core), libdlib-dev (when the
benchmarks were built). Times are CPU times of one thread, medians. On a shared machine only their ratios are
meaningful.

    test/benchmark/peers.py FOLDER [--tools FOLDER] folder of regression_benchmark and calibrator_benchmark, and
                                                    folder of train, simulate, study and rosbag_peer
"""
import argparse
import datetime
import json
import os
import platform
import resource
import subprocess
import sys
import tempfile
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"
import numpy as np  # noqa: E402  (reads the number of threads when loaded)

CODES = 4096
TREES, LEAF = 150, 5
SECTIONS = 5
TAXELS = 70
SCHEMES = ["baseline", "method_1", "method_2", "method_3", "method_4"]
CURVATURE = [0.0, 7.69, 9.09, 11.1, 14.3, 20.0]
PAPER_BANDWIDTH = 2.0**-7


def cpu_seconds(work, repetitions):
    """Median CPU time of work(), and the result of its last call."""
    times = []
    for _ in range(repetitions):
        start = time.process_time()
        result = work()
        times.append(time.process_time() - start)
    return float(np.median(times)), result


def rmse_percent(answers, pressure):
    return 100.0 * np.sqrt(np.mean((answers - pressure) ** 2)) / np.ptp(pressure)


def read(path):
    return np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)


class Table:
    """Rows of the report (work, package, its seconds, our speed-up, remark), and the targets."""

    def __init__(self, ours):
        self.ours = ours
        self.rows = []
        self.targets = []

    def add(self, work, peer, seconds, ours, quality=""):
        """Adds a row; returns the factor by which our code is faster."""
        self.rows.append((work, peer, seconds, seconds / self.ours[ours], quality))
        return seconds / self.ours[ours]

    def ratio(self, work, peer):
        """Factor by which our code is faster; None where the other package is not installed."""
        return next((row[3] for row in self.rows if row[0] == work and row[1] == peer), None)

    def target(self, what, wanted, value, met, unit):
        number = None if value is None else "%.3g" % value if value < 1000 else "{:,.0f}".format(value)
        reached = "not measured" if value is None else number + " " + unit
        self.targets.append((what, wanted, reached, "" if value is None else "yes" if met(value) else "NO"))

    def at_least(self, what, least, value):
        self.target(what, ">= %g x" % least, value, lambda v: v >= least, "x")

    def at_most(self, what, most, unit, value):
        self.target(what, "<= %g %s" % (most, unit), value, lambda v: v <= most, unit)

    def show_targets(self):
        print("%s, %s, %d cores\n" % (datetime.date.today(), processor(), os.cpu_count()))
        print("| what | wanted | reached | met |")
        print("|---|---|---|---|")
        for row in self.targets:
            print("| %s | %s | %s | %s |" % row)
        print()

    def show(self):
        print("| work | peer | peer [ms] | ours is faster by | quality |")
        print("|---|---|---|---|---|")
        for work, peer, seconds, ratio, quality in self.rows:
            print("| %s | %s | %.3g | %.3g | %s |" % (work, peer, 1e3 * seconds, ratio, quality))


def processor():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else platform.machine()


def benchmarks(binary, repetitions):
    """Median of each benchmark, from the output of Google Benchmark."""
    output = subprocess.run(
        [binary, "--benchmark_format=json", "--benchmark_repetitions=%d" % repetitions, "--benchmark_min_time=0.1"],
        check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    return {e["run_name"]: e for e in json.loads(output)["benchmarks"] if e.get("aggregate_name") == "median"}


def our_times(binary, repetitions):
    """Median CPU seconds of each benchmark."""
    scale = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3}
    return {name: entry["cpu_time"] * scale[entry["time_unit"]]
            for name, entry in benchmarks(binary, repetitions).items()}


# --- the GRNN -----------------------------------------------------------------------------------


def dense_grnn(inputs, pressure, queries):
    """The formula in float64; the smallest exponent is subtracted. Inputs [samples x inputs], in bandwidths."""
    answers = np.empty(len(queries))
    for start in range(0, len(queries), 100):
        block = queries[start:start + 100]
        exponent = sum((block[:, None, i] - inputs[None, :, i]) ** 2 for i in range(inputs.shape[1])) / 2.0
        weight = np.exp(exponent.min(axis=1, keepdims=True) - exponent)
        answers[start:start + 100] = weight @ pressure / weight.sum(axis=1)
    return answers


def filtered(values, sigma):
    from scipy.ndimage import gaussian_filter1d
    return gaussian_filter1d(values, sigma, mode="constant", truncate=min(9.0, (CODES - 1) / sigma))


def scipy_grnn(code, pressure, queries, bandwidth):
    """GRNN by histogram and filter, the fastest short implementation known to us. NaN beyond the filter's reach."""
    sigma = code.std(ddof=1) * bandwidth
    count = np.bincount(code, minlength=CODES).astype(float)
    total = np.bincount(code, weights=pressure, minlength=CODES)
    with np.errstate(all="ignore"):
        return (filtered(total, sigma) / filtered(count, sigma))[queries]


def compare_grnn(table, folder, repetitions):
    train, test = read(folder + "/6000_train.csv"), read(folder + "/6000_test.csv")
    ours = read(folder + "/6000_grnn.csv")[:, 0]
    work = "GRNN, 6,000 readings and %d answers" % len(test)
    scale = train[:, 0].std(ddof=1) * PAPER_BANDWIDTH
    seconds, dense = cpu_seconds(
        lambda: dense_grnn(train[:, :1] / scale, train[:, 1], test[:, :1] / scale), repetitions)
    apart = np.abs(dense - ours).max() / np.ptp(train[:, 1])
    table.add(work, "numpy, dense", seconds, "GrnnTable/6000", "we differ by %.1e of the range" % apart)
    table.at_least("GRNN of 6,000 readings and 1,500 answers, against dense sums in Eigen", 300,
                   table.add(work, "Eigen, dense, same binary", table.ours["GrnnDenseEigen/6000"], "GrnnTable/6000"))
    try:
        code, queries = train[:, 0].astype(int), test[:, 0].astype(int)
        scipy_grnn(code, train[:, 1], queries, PAPER_BANDWIDTH)
    except ImportError:
        return
    seconds, answers = cpu_seconds(
        lambda: [scipy_grnn(code, train[:, 1], queries, PAPER_BANDWIDTH) for _ in range(20)][-1], repetitions)
    lost = int(np.isnan(answers).sum())
    table.at_least("the same, against numpy's histogram and scipy's filter", 3, table.add(
        work, "numpy bincount, scipy filter", seconds / 20, "GrnnTable/6000", "NaN on %d answers" % lost))
    compare_every_code(table, train, folder)


def compare_every_code(table, train, folder):
    """Compares the whole table with log-sum-exp in long double, including far codes and gaps."""
    ours = read(folder + "/6000_grnn_table.csv")[:, 0]
    code, counts = np.unique(train[:, 0].astype(int), return_counts=True)
    sums = np.bincount(train[:, 0].astype(int), weights=train[:, 1], minlength=CODES)[code].astype(np.longdouble)
    sigma = np.longdouble(train[:, 0].std(ddof=1)) * np.longdouble(PAPER_BANDWIDTH)
    worst = 0.0
    for reading in range(CODES):
        exponent = ((code - reading) / sigma) ** 2 / 2
        weight = np.exp(exponent.min() - exponent)
        exact = (weight * sums).sum() / (weight * counts).sum()
        worst = max(worst, abs(float(exact - ours[reading])))
    table.at_most("GRNN at every code, error against long double", 1e-12, "of the range",
                  worst / np.ptp(train[:, 1]) if np.isfinite(ours).all() else float("inf"))


# --- the study ----------------------------------------------------------------------------------


def models_of(scheme, cells):
    """Models of a scheme: lists of groups (input, sections); a section is (code, pressure)."""

    def group(value, conditions, stride):
        def section(k):
            parts = [cells[c][k][::stride] for c in conditions]
            whole = np.concatenate(parts)
            return whole[:, 0].astype(int), whole[:, 1]
        return value, [section(k) for k in range(SECTIONS)]

    bent = range(1, 6)
    return {
        "baseline": [[group(0.0, range(6), 6)]],
        "method_1": [[group(0.0, [c], 1)] for c in range(6)],
        "method_2": [[group(CURVATURE[c], [c], 6) for c in range(6)]],
        "method_3": [[group(0.0, [0], 1)], [group(0.0, bent, 5)]],
        "method_4": [[group(0.0, [0], 1), group(1.0, bent, 5)]],
    }[scheme]


def fold(groups, held_out):
    """Training readings of each group, deviation of the inputs, and the held-out section."""
    train = [(value, *(np.concatenate(x) for x in zip(*(s for k, s in enumerate(sections) if k != held_out))))
             for value, sections in groups]
    code = np.concatenate([g[1] for g in train])
    value = np.concatenate([np.full(len(g[1]), g[0]) for g in train])
    test = [(value, *sections[held_out]) for value, sections in groups]
    return train, code.std(ddof=1), value.std(ddof=1) if len(groups) > 1 else 1.0, test


def dense_fold(groups, held_out, bandwidth):
    train, scale, input_scale, test = fold(groups, held_out)

    def inputs(parts):
        return np.concatenate([np.c_[c / scale, np.full(len(c), v / input_scale)] for v, c, _ in parts]) / bandwidth
    columns = 2 if len(groups) > 1 else 1
    pressure = np.concatenate([p for _, _, p in test])
    answers = dense_grnn(inputs(train)[:, :columns], np.concatenate([p for _, _, p in train]),
                         inputs(test)[:, :columns])
    return rmse_percent(answers, pressure)


def scipy_fold(groups, held_out, bandwidth):
    train, scale, input_scale, test = fold(groups, held_out)
    sums = [(v, filtered(np.bincount(c, weights=p, minlength=CODES), scale * bandwidth),
             filtered(np.bincount(c, minlength=CODES).astype(float), scale * bandwidth)) for v, c, p in train]
    answers = []
    with np.errstate(all="ignore"):
        for value, code, _ in test:
            near = [np.exp(-0.5 * ((v - value) / input_scale / bandwidth) ** 2) for v, _, _ in sums]
            total = sum(w * s for w, (_, s, _) in zip(near, sums))
            weight = sum(w * n for w, (_, _, n) in zip(near, sums))
            answers.append((total / weight)[code])
    return np.concatenate(answers), np.concatenate([p for _, _, p in test])


def compare_study(table, folder):
    taxel = read(folder + "/taxel.csv")
    cells = [[taxel[(taxel[:, 0] == c) & (taxel[:, 1] == k)][:, 2:] for k in range(SECTIONS)] for c in range(6)]
    study = np.genfromtxt(folder + "/study.csv", delimiter=",", skip_header=1, dtype=None, encoding=None)
    ours = {(row[0], row[1]): row[2] for row in study}
    bandwidths = sorted({row[1] for row in study})
    work = "GRNN study of a taxel, 5 schemes x %d bandwidths x %d sections" % (len(bandwidths), SECTIONS)

    worst, seconds = 0.0, 0.0
    for scheme in SCHEMES:
        models = models_of(scheme, cells)
        start = time.process_time()
        rmse = np.mean([dense_fold(groups, k, PAPER_BANDWIDTH) for groups in models for k in range(SECTIONS)])
        seconds += time.process_time() - start
        worst = max(worst, abs(rmse - ours[scheme, PAPER_BANDWIDTH]))
    table.at_least("GRNN study of the paper's schemes, against numpy", 400, table.add(
        work, "numpy, dense (one bandwidth timed)", seconds * len(bandwidths), "GrnnStudyOfATaxel",
        "RMSE%% differs by %.0e" % worst))
    table.at_most("the same, RMSE % against dense sums", 1e-8, "RMSE %", worst)
    try:
        start, lost = time.process_time(), 0
        for scheme in SCHEMES:
            for groups in models_of(scheme, cells):
                for k in range(SECTIONS):
                    for bandwidth in bandwidths:
                        lost += int(np.isnan(scipy_fold(groups, k, bandwidth)[0]).sum())
        table.at_least("the same, against numpy's histogram and scipy's filter", 5, table.add(
            work, "numpy bincount, scipy filter", time.process_time() - start, "GrnnStudyOfATaxel",
            "NaN on %d answers" % lost))
    except ImportError:
        pass


# --- the forest ---------------------------------------------------------------------------------


def forest_scikit_learn(train, test, repetitions):
    from sklearn.ensemble import RandomForestRegressor
    forest = RandomForestRegressor(TREES, min_samples_leaf=LEAF, n_jobs=1)
    seconds, _ = cpu_seconds(lambda: forest.fit(train[:, :1], train[:, 1]), repetitions)
    predicting, answers = cpu_seconds(lambda: forest.predict(test[:, :1]), repetitions)
    return seconds, rmse_percent(answers, test[:, 1]), predicting / len(test)


def forest_opencv(train, test, repetitions):
    import cv2
    cv2.setNumThreads(1)
    code, pressure = train[:, :1].astype(np.float32), train[:, 1].astype(np.float32)

    def train_once():
        forest = cv2.ml.RTrees_create()
        forest.setTermCriteria((cv2.TERM_CRITERIA_MAX_ITER, TREES, 0))
        forest.setMinSampleCount(2 * LEAF)
        forest.setMaxDepth(30)
        forest.setRegressionAccuracy(0)
        forest.setActiveVarCount(1)
        forest.train(code, cv2.ml.ROW_SAMPLE, pressure)
        return forest
    seconds, forest = cpu_seconds(train_once, repetitions)
    predicting, answers = cpu_seconds(lambda: forest.predict(test[:, :1].astype(np.float32))[1][:, 0], repetitions)
    return seconds, rmse_percent(answers, test[:, 1]), predicting / len(test)


RANGER = """
suppressMessages(library(ranger)); a <- commandArgs(TRUE)
train <- read.csv(a[1]); test <- read.csv(a[2])
for (i in seq_len(as.integer(a[3]))) {
  t <- system.time(m <- ranger(pressure ~ code, train, num.trees = %d, mtry = 1, min.node.size = %d, num.threads = 1))
  cat(t[["user.self"]] + t[["sys.self"]], "\\n") }
cat(sqrt(mean((predict(m, test, num.threads = 1)$predictions - test$pressure)^2)), "\\n")
""" % (TREES, 2 * LEAF)


def forest_program(command, test):
    """Runs a program that prints the CPU seconds of each training and finally its RMSE [Pa]."""
    run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if run.returncode != 0:
        raise ImportError(command[0])
    values = [float(v) for v in run.stdout.split()]
    return float(np.median(values[:-1])), 100.0 * values[-1] / np.ptp(test[:, 1]), None


def compare_forest(table, folder, programs, repetitions):
    for number in (6000, 36000):
        files = ["%s/%d_%s.csv" % (folder, number, part) for part in ("train", "test")]
        train, test = (read(path) for path in files)
        ours, distinct = (rmse_percent(read("%s/%d_%s.csv" % (folder, number, name))[:, 0], test[:, 1])
                          for name in ("forest", "forest_distinct"))
        trained = []
        peers = {
            "scikit-learn": lambda: forest_scikit_learn(train, test, repetitions),
            "OpenCV": lambda: forest_opencv(train, test, repetitions),
            "ranger": lambda: forest_program(["Rscript", "-e", RANGER, *files, str(repetitions)], test),
            "dlib": lambda: forest_program(
                [os.path.join(programs, "dlib_forest_peer"), *files, str(repetitions)], test),
        }
        for name, measure in peers.items():
            try:
                seconds, rmse, predicting = measure()
            except (ImportError, OSError):
                print("%s is not installed" % name)
                continue
            trained.append(table.add("forest, %d readings" % number, name, seconds, "ForestTable/%d" % number,
                                     "RMSE%% %.3f, ours %.3f" % (rmse, distinct if name == "scikit-learn" else ours)))
            if name == "scikit-learn":  # its minimum leaf has the same meaning as one of our options
                table.at_most("forest of %d readings, RMSE %% against scikit-learn's, same leaf rule" % number,
                              0.05, "RMSE %", abs(rmse - distinct))
            if predicting is not None:
                table.ours["TableLookUp/1"] = table.ours["TableLookUp"] / len(test)
                times = table.add("forest, an answer", name, predicting, "TableLookUp/1")
                if name == "scikit-learn" and number == 6000:
                    table.at_least("an answer of the forest, against scikit-learn", 10000, times)
        if trained:
            table.at_least("forest of %d readings, against the fastest peer" % number, 20 if number == 6000 else 60,
                           min(trained))


# --- the live path, training, memory -----------------------------------------------------------


def compare_calibrator(table, binary, repetitions):
    found = benchmarks(binary, repetitions)
    names = {"70": ("Calibrate/load_cycles/7/10", "CopyScanToFloat/7/10", 200),
             "1,024": ("Calibrate/load_cycles/32/32", "CopyScanToFloat/32/32", 10000)}
    for taxels, (name, copy, most) in names.items():
        nanoseconds = found[name]["cpu_time"]
        table.at_most("a scan of %s taxels to pressure, deviation and flags (%.0f x copying it)"
                      % (taxels, nanoseconds / found[copy]["cpu_time"]), most, "ns", nanoseconds)
    table.at_most("tables in use, 7 x 10 taxels, 12 bit, six classes", 25, "MB", found["Calibrate/load_cycles/7/10"]["MB"])
    table.at_most("tables in use, 16 x 10 taxels, 16 bit, six classes", 200, "MB", found["FineConverter/16/10"]["MB"])


def children_seconds(command, repetitions):
    """Median CPU time of a program."""
    times = []
    for _ in range(repetitions):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return float(np.median(times))


def compare_training(table, tools, folder, repetitions):
    """Generates six bags of 7,500 scans x 70 taxels."""
    settings = os.path.join(os.path.dirname(__file__), "..", "..", "config", "simulation", "paper.yaml")
    bags, output = os.path.join(folder, "bags"), os.path.join(folder, "calibration.h5")
    children_seconds([os.path.join(tools, "simulate"), "--simulation", settings, "--output", bags], 1)
    files = sorted(os.path.join(bags, name) for name in os.listdir(bags) if name.endswith(".bag"))
    reader = subprocess.run([os.path.join(tools, "rosbag_peer"), str(repetitions), *files], check=True,
                            stdout=subprocess.PIPE).stdout
    reading = float(np.median([float(v) for v in reader.split()]))
    train = [os.path.join(tools, "train"), *files, "--output", output]
    fixed = children_seconds(train + ["--bandwidth", str(PAPER_BANDWIDTH), "--no-scores"], repetitions)
    table.at_most("train on six bags, bandwidth given, no scores, in times of merely reading them with rosbag",
                  4, "x", fixed / reading)
    table.at_most("train on six bags, bandwidth chosen, with scores", 8, "s of CPU", children_seconds(train, repetitions))
    study = [os.path.join(tools, "study"), *files, "--paper-only", "--no-figures",
             "--output", os.path.join(folder, "study")]
    table.at_most("the whole study of the paper", 20, "s of CPU", children_seconds(study, 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", help="the folder that holds regression_benchmark and calibrator_benchmark")
    parser.add_argument("--tools", help="the folder that holds train, simulate, study and rosbag_peer")
    parser.add_argument("--repetitions", type=int, default=5)
    arguments = parser.parse_args()
    binary = os.path.join(arguments.folder, "regression_benchmark")
    if not os.path.exists(binary):
        sys.exit("%s does not exist; build the target benchmarks with -DFSR_BUILD_BENCHMARKS=ON" % binary)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([binary, "--export=" + folder], check=True)
        table = Table(our_times(binary, arguments.repetitions))
        compare_grnn(table, folder, arguments.repetitions)
        compare_study(table, folder)
        compare_forest(table, folder, arguments.folder, arguments.repetitions)
        compare_calibrator(table, os.path.join(arguments.folder, "calibrator_benchmark"), arguments.repetitions)
        if arguments.tools:
            compare_training(table, arguments.tools, folder, min(3, arguments.repetitions))
        again = our_times(binary, arguments.repetitions)
    table.show_targets()
    table.show()
    print("\nours [ms], before and after the peers:")
    for name, seconds in table.ours.items():
        if name in again:
            print("%-28s %10.4g %10.4g" % (name, 1e3 * seconds, 1e3 * again[name]))


if __name__ == "__main__":
    main()
