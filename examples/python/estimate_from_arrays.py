#!/usr/bin/env python3
"""Young's modulus of a bar from arrays, and what its model misses. Editors show the parts between `# %%` as cells.

usage: estimate_from_arrays.py [FOLDER]   (for the picture; default: here)
"""
# %% A bar of foam, held at x = 0, is pulled, held and let go. Its end is tracked.
import os
import sys

import numpy as np
import tissue_stiffness as ts

MODEL = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'estimate_from_arrays', 'model.yaml')
FOLDER = sys.argv[1] if len(sys.argv) > 1 else '.'
LENGTH, AREA, MODULUS = 0.1, 0.02 * 0.02, 12e3  # [m], [m^2], [Pa]
model = ts.Model(MODEL)
# These forces are known exactly, and straight elements of 4 nodes follow this motion exactly.
exact = model.text.replace('faceted', 'faceted, order: 1, discretisation_error: false') + 'inputs: exact\n'
model = ts.Model.from_text(exact, model.directory)
mesh = ts.build_mesh(model)
end = np.flatnonzero(mesh.nodes[:mesh.corner_count, 0] > LENGTH - 1e-6)
stamps = np.arange(61) / 30                                            # [s]
force = np.interp(stamps, [0, 0.2, 1, 1.2], [0, 0.2, 0.2, 0])          # [N]
elastic = force / AREA * LENGTH / MODULUS                              # elongation of a bar that does not creep [m]
noise = np.random.default_rng(1).normal(0, 1e-4, (len(stamps), len(end), 3))


def seen(elongation):
    """Frames of the end's vertices, (61, 9, 3) [m], with the force."""
    points = mesh.nodes[end] + elongation[:, None, None] * [1, 0, 0] + noise
    return ts.make_frames(stamps, points, topic='end', ids=end, loads={'force': force[:, None] * [1, 0, 0]})


# %% Frame after frame, as they come from a sensor.
estimator = ts.Estimator(model)
for frame in seen(elastic)[:31]:
    step = estimator.step(frame)
print('after %.1f s: E = %.2f kPa (%.2f to %.2f), %s' % (
    stamps[30], step.young_modulus / 1e3, *np.divide(step.interval, 1e3), step.state))

# %% All at once, with a table and a picture.
result = ts.estimate(model, seen(elastic))
table = result.columns()
print('after %.1f s: E = %.2f kPa' % (table['stamp'][-1], table['E'][-1] / 1e3))
result.plot(os.path.join(FOLDER, 'young_modulus.png'))

# %% A bar that creeps: a branch of half its stiffness relaxes within 0.3 s. The model does not know.
creeping, branch = np.zeros(len(stamps)), 0.0
for i in range(1, len(stamps)):
    for part in np.linspace(0, 1, 1000):
        now = (elastic[i - 1] + part * (elastic[i] - elastic[i - 1]) + 0.5 * branch) / 1.5
        branch += (now - branch) / 0.3 * (stamps[i] - stamps[i - 1]) / 1000
    creeping[i] = now
diagnosis = ts.diagnose(model, seen(creeping))
print('%s: %s' % (diagnosis.verdict, ', '.join('%s %.0f %%' % (name, 100 * p) for name, p in diagnosis.probabilities.items())))
