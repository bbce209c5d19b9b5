#!/usr/bin/python3
"""Writes regression.csv: readings of one imagined taxel on six surfaces, and prints what other
packages make of it: the numbers that test/regression/forest_test.cpp and regressors_test.cpp hold ours
against. Packages: python3-numpy python3-sklearn; for ranger r-base-core r-cran-ranger."""
import os
import subprocess

import numpy as np
from sklearn.ensemble import RandomForestRegressor
from sklearn.linear_model import LinearRegression
from sklearn.tree import DecisionTreeRegressor

FOLDER = os.path.dirname(os.path.abspath(__file__))
CURVATURES = [0.0, 7.69, 9.09, 11.1, 14.3, 20.0]  # [1/m]
SEEDS = 20
RANGER = """
suppressMessages(library(ranger))
d <- read.csv("%s/regression.csv"); train <- d[d$held_out == 0, ]; test <- d[d$held_out == 1, ]
r <- sapply(1:%d, function(seed) {
  m <- ranger(pressure ~ code + curvature, train, num.trees = 150, mtry = 1, min.node.size = 5, seed = seed)
  e <- predict(m, test)$predictions - test$pressure
  100 * sqrt(mean(e^2)) / diff(range(test$pressure)) })
cat(sprintf("ranger, two inputs, one drawn: RMSE%%%% %%.4f +- %%.4f\\n", mean(r), sd(r)))
"""


def write_data():
    random = np.random.default_rng(20240501)
    rows = []
    for k, curvature in enumerate(CURVATURES):
        time = np.arange(300)
        phase = (time / 60.0) % 1.0  # five cycles
        pressure = 620e3 * np.sin(np.pi * phase) ** 2
        loop = 0.02 * np.sign(np.cos(np.pi * phase)) * np.sin(np.pi * phase)
        gain = 1.0 - (0.0 if k == 0 else 0.12 + 0.005 * curvature)
        load = np.maximum(pressure + (0.0 if k == 0 else 34e3), 0.0) / 620e3
        reading = 60 + 3300 * gain * (load**0.7 - loop) + 40 * random.standard_normal(time.size)
        code = np.clip(np.rint(reading), 0, 4095).astype(int)
        held_out = (time >= 240).astype(int)  # the last cycle
        rows += zip(code, np.round(pressure, 2), [curvature] * time.size, held_out)
    with open(os.path.join(FOLDER, "regression.csv"), "w") as out:
        out.write("code,pressure,curvature,held_out\n")
        out.writelines("%d,%.2f,%g,%d\n" % row for row in rows)


def main():
    write_data()
    data = np.loadtxt(os.path.join(FOLDER, "regression.csv"), delimiter=",", skiprows=1)
    train, test = data[data[:, 3] == 0], data[data[:, 3] == 1]
    scale = 100.0 / np.ptp(test[:, 1])

    def rmse(predicted):
        return scale * np.sqrt(np.mean((predicted - test[:, 1]) ** 2))

    for name, columns, features in [("one input", [0], 1.0), ("two inputs, one drawn", [0, 2], 1)]:
        scores = []
        for seed in range(SEEDS):
            forest = RandomForestRegressor(150, min_samples_leaf=5, max_features=features, random_state=seed)
            forest.fit(train[:, columns], train[:, 1])
            scores.append(rmse(forest.predict(test[:, columns])))
        print("scikit-learn, %s: RMSE%% %.4f +- %.4f" % (name, np.mean(scores), np.std(scores, ddof=1)))
    random, scores = np.random.default_rng(1), []
    for _ in range(SEEDS):
        answers = 0.0
        for _ in range(150):
            drawn = train[random.integers(0, len(train), len(train))]
            tree = DecisionTreeRegressor(min_samples_leaf=5).fit(drawn[:, :1], drawn[:, 1])
            answers = answers + tree.predict(test[:, :1]) / 150
        scores.append(rmse(answers))
    print("scikit-learn, trees on replicas: RMSE%% %.4f +- %.4f" % (np.mean(scores), np.std(scores, ddof=1)))
    line = LinearRegression().fit(train[:, :1], train[:, 1])
    print("scikit-learn, line: RMSE%% %.10f" % rmse(line.predict(test[:, :1])))
    for name, exponent in [
        ("sigma 2^-7", lambda d: -(d**2) * 2.0**13),
        ("newgrnn, spread 2^-6", lambda d: np.log(0.5) * d**2 * 2.0**12),
        ("literal, sigma 2^-3", lambda d: -d * 2.0**5),
    ]:
        w = exponent(np.abs(test[:, :1] - train[:, 0]) / train[:, 0].std(ddof=1))
        w = np.exp(w - w.max(axis=1, keepdims=True))
        print("numpy, GRNN, %s: RMSE%% %.10f" % (name, rmse(w @ train[:, 1] / w.sum(axis=1))))
    subprocess.run(["Rscript", "-e", RANGER % (FOLDER, SEEDS)], check=False)


if __name__ == "__main__":
    main()
