"""What the test of faults and scripts/soak share: a long recording whose truth is known, and how a run with faults is judged."""
import math
import os
import subprocess
import tempfile

import roslib.packages
import yaml

HERE = os.path.dirname(os.path.realpath(__file__))
MODEL = os.path.join(HERE, 'faults_model.yaml')
TRUTH = 12e3       # Pa
CLOUDS = 30.0      # Hz
WRENCHES = 200.0   # Hz
KINDS = ('drop', 'delay', 'duplicate', 'reorder', 'corrupt', 'restamp', 'mute')


def scene(seconds):
    with open(MODEL) as file:
        out = yaml.safe_load(file)
    out['mesh'] = {'file': os.path.join(HERE, out['mesh']['file'])}
    out['effects'][1]['elasticity']['young_modulus'] = TRUTH
    out['simulation'] = {
        'duration': seconds, 'rate': CLOUDS, 'step': 0.004, 'sensors': {'/tissue/vertices': {'every': 5}},
        'loads': {'/tool/wrench': {'rate': WRENCHES, 'terms': [
            {'direction': [0, 0, -1], 'raised_cosine': {'amplitude': 4.8, 'frequency': 1}},
            {'direction': [1, 0, 0], 'sine': {'amplitude': 2.4, 'frequency': 1.5}}]}}}
    return out


def write_recording(seconds, bag):
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, 'scene.yaml')
        with open(file, 'w') as stream:
            yaml.safe_dump(scene(seconds), stream)
        simulate = roslib.packages.find_node('tissue_stiffness', 'simulate')[0]
        subprocess.run([simulate, file, '--allow-outside', '--output', bag], check=True, stdout=subprocess.DEVNULL)


def broken(estimate):
    """Why an estimate is no distribution of a positive modulus; empty when it is one."""
    values = (list(estimate.mean) + list(estimate.std) + list(estimate.lower95) + list(estimate.upper95) +
              list(estimate.covariance) + [estimate.young_modulus, estimate.young_modulus_std,
                                           estimate.young_modulus_lower95, estimate.young_modulus_upper95])
    variances = estimate.covariance[::len(estimate.std) + 1]
    if not all(math.isfinite(value) for value in values):
        return 'a number is not finite'
    if not (estimate.young_modulus_lower95 > 0.0 and all(value > 0.0 for value in list(estimate.std) + list(variances))):
        return 'a modulus or a variance is not positive'
    if not estimate.young_modulus_lower95 < estimate.young_modulus < estimate.young_modulus_upper95:
        return 'the interval does not hold the mean'
    return ''


def excludes_truth(estimate):
    return not estimate.young_modulus_lower95 <= TRUTH <= estimate.young_modulus_upper95


def spells(faults, quiet, active):
    """[(end, start of the next one)] of the spells of faults [s]; a mute or a delay ends later than it begins."""
    ends = {}
    for fault in faults:
        stamp = fault.header.stamp.to_sec()
        number = stamp // (quiet + active)
        lasts = fault.seconds if fault.fault in ('mute', 'delay') else 0.0
        ends[number] = max(ends.get(number, 0.0), stamp + lasts)
    return [(end, (number + 1) * (quiet + active) + quiet) for number, end in sorted(ends.items())]


def recovery(estimates, end, until):
    """Seconds from the end of a spell to the last estimate before `until` that is not converged; 0: all of them are."""
    late = [estimate.header.stamp.to_sec() for estimate in estimates if estimate.state != 'converged']
    return max([stamp - end for stamp in late if end < stamp < until] or [0.0])
