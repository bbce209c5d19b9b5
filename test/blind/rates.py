"""Rates of cases with two intervals: the exact one, and one that knows that cases of one form or one sheet are alike."""

import math

import numpy

DRAWS = 2000  # of the bootstrap


def binomial_tail(k, n, p):
    """P(X >= k), X binomial."""
    if k <= 0:
        return 1.0
    if p <= 0 or p >= 1:
        return float(p >= 1)
    logs = [math.lgamma(n + 1) - math.lgamma(i + 1) - math.lgamma(n - i + 1) + i * math.log(p) + (n - i) * math.log1p(-p)
            for i in range(k, n + 1)]
    return min(1.0, math.fsum(math.exp(x) for x in logs))


def solve(rising, target):
    """The argument in 0 .. 1 at which an increasing function reaches `target`."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < target else (low, middle)
    return (low + high) / 2


def clopper_pearson(k, n, level=0.95):
    """Exact interval of a rate: k of n."""
    if n == 0:
        return (0.0, 1.0)
    alpha = (1 - level) / 2
    low = 0.0 if k == 0 else solve(lambda p: binomial_tail(k, n, p), alpha)
    high = 1.0 if k == n else solve(lambda p: binomial_tail(k + 1, n, p), 1 - alpha)
    return (low, high)


def counts_by(clusters, values):
    """[clusters x 2]: number of true values and number of values in each cluster."""
    rows = {}
    for cluster, value in zip(clusters, values):
        row = rows.setdefault(cluster, [0, 0])
        row[0] += bool(value)
        row[1] += 1
    return numpy.array(list(rows.values()), dtype=float)


def bootstrap(clusters, values):
    """95 % interval of the rate when whole clusters are drawn again. Clusters that all agree give the draws no width; then
    the exact interval is taken, with the number of clusters in the place of the number of cases. None with one cluster."""
    counts = counts_by(clusters, values)
    number, rate = len(counts), counts[:, 0].sum() / counts[:, 1].sum()
    if number < 2:
        return None
    if rate in (0, 1):
        return clopper_pearson(int(rate * number), number)
    draws = numpy.random.default_rng(1).multinomial(number, [1 / number] * number, size=DRAWS) @ counts
    low, high = numpy.quantile(draws[:, 0] / draws[:, 1], [0.025, 0.975])
    return (float(low), float(high))


def clustered(rows, values):
    """The wider of two bootstraps at either end: over forms, and over sheets."""
    both = [bootstrap([row[field] for row in rows], values) for field in ("cluster", "sheet")]
    if None in both:
        return None
    return (min(b[0] for b in both), max(b[1] for b in both))


def rate(rows, what):
    """Share of the rows for which what(row) is true; rows for which it is None do not count."""
    pairs = [(row, value) for row, value in ((row, what(row)) for row in rows) if value is not None]
    chosen, values = [p[0] for p in pairs], [bool(p[1]) for p in pairs]
    k, n = sum(values), len(values)
    if n == 0:
        return {"k": 0, "n": 0, "rate": None, "naive": None, "clustered": None}
    return {"k": k, "n": n, "rate": k / n, "naive": clopper_pearson(k, n), "clustered": clustered(chosen, values)}
