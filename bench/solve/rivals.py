"""The counterpart of against_python.cpp: times numpy and scipy on the matrices in a folder, and prints JSON.

usage: rivals.py FOLDER   (with rows.npy, gram.npy, rhs.npy; OPENBLAS_NUM_THREADS set before)"""
import json
import subprocess
import sys
import time

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import nnls


def best_of(runs, run):
    """Returns the minimum time of several runs, in microseconds."""
    best = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - start)
    return 1e6 * best


def blas_library():
    """Returns the shared library that runs numpy's products."""
    with open("/proc/self/maps") as maps:
        names = {line.split()[-1] for line in maps if "blas" in line}
    return ", ".join(sorted(name.rsplit("/", 1)[-1] for name in names)) or "unknown"


folder = sys.argv[1]
rows = np.load(folder + "/rows.npy")
gram = np.load(folder + "/gram.npy")
rhs = np.load(folder + "/rhs.npy").ravel()
result = {}

# To numpy, A'A of one array is a symmetric update. The faster of both layouts counts. In double, the faster of two ways
# counts: one product of a converted copy, and products of blocks that are converted one by one.
columns = np.ascontiguousarray(rows.T)
result["gram_float"] = min(best_of(5, lambda: rows.T @ rows), best_of(5, lambda: columns @ columns.T))


def gram_by_blocks():
    total = np.zeros((len(columns), len(columns)))
    for start in range(0, columns.shape[1], 1 << 15):
        part = columns[:, start : start + (1 << 15)].astype(np.float64)
        total += part @ part.T
    return total


by_blocks = best_of(5, gram_by_blocks)
columns = columns.astype(np.float64)
result["gram_double"] = min(by_blocks, best_of(5, lambda: columns @ columns.T))
del columns, rows

# min |A x - b| over x >= 0 with the given Cholesky factor of A'A.
factor = cholesky(gram)
right = solve_triangular(factor, rhs, trans="T")
result["nnls"] = best_of(200, lambda: nnls(factor, right))

result["blas"] = blas_library()
print(json.dumps(result))
