"""A plain NumPy and SciPy peer on the problem that `performance --export` writes: an unscented filter of log E whose sigma
points' trajectories step with Newmark's average acceleration, each with a sparse LU factor of its own that follows its
modulus. Prints JSON: median seconds a frame, E at the end.
usage: peer.py FOLDER [SUBSTEPS]"""
import json
import os
import sys
import time

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu


# SuperLU's defaults and its settings for symmetric matrices: which is faster depends on the size.
SETTINGS = ({}, {'permc_spec': 'MMD_AT_PLUS_A', 'diag_pivot_thresh': 0.0, 'options': {'SymmetricMode': True}})


def faster_settings(matrix):
    def seconds(settings):
        start = time.perf_counter()
        splu(matrix, **settings)
        return time.perf_counter() - start
    return min(SETTINGS, key=seconds)


def read_problem(folder):
    with open(os.path.join(folder, 'problem.json')) as file:
        problem = json.load(file)

    def numbers(name, kind=np.float64):
        return np.fromfile(os.path.join(folder, name + '.bin'), dtype=kind)

    for name, rows in (('mass', problem['dofs']), ('stiffness', problem['dofs']), ('observe', problem['rows'])):
        problem[name] = csc_matrix(
            (numbers(name + '_data'), numbers(name + '_indices', np.int32), numbers(name + '_indptr', np.int32)),
            shape=(rows, problem['dofs']))
    problem['weight'] = numbers('weight')
    problem['measured'] = numbers('measured').reshape(problem['frames'], -1)
    problem['observe'] = problem['observe'].tocsr()
    return problem


class Trajectory:
    """Newmark's average acceleration from rest."""

    def __init__(self, problem, step):
        self.problem, self.step = problem, step
        self.u = np.zeros(problem['dofs'])
        self.v = np.zeros(problem['dofs'])
        self.a = splu(problem['mass'], **problem['settings']).solve(problem['weight'])

    def advance(self, modulus, steps):
        p, h = self.problem, self.step
        factor = splu((modulus * p['stiffness'] + 4.0 / h**2 * p['mass']).tocsc(), **p['settings'])
        for _ in range(steps):
            inertia = 4.0 / h**2 * self.u + 4.0 / h * self.v + self.a
            u = factor.solve(p['weight'] + p['mass'] @ inertia)
            a = 4.0 / h**2 * u - inertia
            self.v += 0.5 * h * (self.a + a)
            self.u, self.a = u, a


def run(problem, substeps):
    problem['settings'] = faster_settings((problem['prior'] * problem['stiffness'] + problem['mass']).tocsc())
    points = [Trajectory(problem, problem['interval'] / substeps) for _ in range(3)]
    mean, variance = np.log(problem['prior']), np.log(2.0)**2
    seconds = []
    for measured in problem['measured']:
        start = time.perf_counter()
        spread = np.sqrt(3.0 * variance)  # kappa = 2: weights 2/3, 1/6, 1/6
        offsets = np.array([0.0, spread, -spread])
        for point, offset in zip(points, offsets):
            point.advance(np.exp(mean + offset), substeps)
        rows = np.array([problem['observe'] @ point.u for point in points])
        weights = np.array([2.0, 0.5, 0.5]) / 3.0
        predicted = weights @ rows
        # One parameter: the gain by Woodbury, without a rows x rows matrix.
        slope = (weights * offsets) @ (rows - predicted) / variance
        information = slope @ slope / problem['noise']**2 + 1.0 / variance
        mean += slope @ (measured - predicted) / problem['noise']**2 / information
        variance = 1.0 / information
        seconds.append(time.perf_counter() - start)
    return {'seconds_per_frame': float(np.median(seconds)), 'modulus': float(np.exp(mean)), 'frames': len(seconds)}


if __name__ == '__main__':
    print(json.dumps(run(read_problem(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 4)))
