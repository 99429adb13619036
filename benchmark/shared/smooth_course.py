"""Courses of what a rig or an arm moves."""
import numpy as np


def smooth(times, values):
    """A course through its knots without jolts."""
    def course(t):
        k = int(np.clip(np.searchsorted(times, t, side='right') - 1, 0, len(times) - 2))
        s = np.clip((t - times[k]) / (times[k + 1] - times[k]), 0, 1)
        return values[k] + (values[k + 1] - values[k]) * s ** 3 * (10 - 15 * s + 6 * s * s)
    return course
