"""What a rig records on truths of the independent simulator: smooth motions, the force on a tool, and what `estimate` finds."""
import json
import os
import subprocess

import genpy
import numpy as np
from geometry_msgs.msg import WrenchStamped

from foreign import START, simulate_header

FAR_PRIOR = (0.4, 0.6, 1.7, 2.5)  # prior median over truth


def stamp(t):
    return genpy.Time.from_sec(START + t)


def write_force(bag, forces, rate, share, rng):
    """Writes forces [N] at a rate [Hz], with noise that is a share of the largest one. Returns the noise [N]."""
    noise = share * np.abs(forces).max()
    for k, force in enumerate(forces):
        message = WrenchStamped(header=simulate_header(k, stamp(k / rate)))
        f = message.wrench.force
        f.x, f.y, f.z = force + noise * rng.standard_normal(3)
        bag.write('/tool/wrench', message, message.header.stamp)
    return float(noise)


def estimated(program, model, recording, out):
    """Returns the results and the exit code."""
    run = subprocess.run([program, model, recording, '--output', out], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if run.returncode not in (0, 3):
        raise RuntimeError(run.stdout)
    with open(os.path.join(out, 'results.json')) as file:
        return json.load(file), run.returncode
