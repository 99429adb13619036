"""Draws of the foreign study: which truth, what is wrong with its sensors or its model file, and what is honest."""
import json
import os

import numpy as np
import rosbag
import sensor_msgs.point_cloud2 as point_cloud2
import yaml
from geometry_msgs.msg import WrenchStamped
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import FluidPressure, PointField
import genpy

import errors
import foreign_bodies as bodies
from foreign import START, simulate_header
from foreign_truths import Scene, truth_list

COUNTS = {'clean': 80, 'one': 66, 'two': 60, 'declared': 66, 'outside': 60, 'removed': 48}
NOISES = ['stated', 'stated too small', 'stated too large', 'correlated', '10 % outliers', '20 % outliers',
          'few sensors', 'one side']
USUAL = ['stated', 'stated', 'correlated', 'half the sensors']  # of what has something else that is wrong
DECLARED = ['density', 'poisson', 'gravity direction', 'gravity size', 'load gain', 'load zero', 'load direction',
            'time offset', 'image scale', 'clamp too large', 'clamp too small']
STARTS = (0.5, 0.7, 1.5, 2.0)  # prior over truth
MEMORY, MISSTATED, FEW, OUTLIER = 0.6, 1.5, 12, 12.0  # the last in standard deviations of the noise

# Groups whose members explain the same recording; to name one for another is honest.
EQUIVALENTS = [
    {'viscous_damping', 'mass_damping', 'viscoelasticity'},     # one mode that rings tells one loss, not where it rises
    {'density_error', 'force_scale'},                           # exact: mass times r, with E, is the load over r
    {'elastic_support', 'foundation', 'stiff_inclusion'},       # each makes a body softer or firmer at its clamp
    {'fibre_reinforcement', 'stiff_inclusion'},                 # fibres that bear little elsewhere firm a part of it
]
# What the library calls a wrong declaration. `sensor_rotation`: a body that is round, or square, about its axis bends
# alike when it is turned about it, whether the load or the camera is. It has no other clamp: only what is like one.
CALLED = {
    'density': {'density_error', 'force_scale'}, 'poisson': {'compressibility'},
    'gravity direction': {'gravity'}, 'gravity size': {'gravity'},
    'load gain': {'force_scale', 'density_error'}, 'load zero': {'load_offset', 'pressure_offset'},
    'load direction': {'load_rotation'},
    'time offset': {'time_offset'}, 'image scale': {'image_scale'},
    'clamp too large': {'elastic_support', 'foundation', 'stiff_inclusion'},
    'clamp too small': {'elastic_support', 'foundation', 'stiff_inclusion'},
}
LAGS = {'time_offset'}  # a lossy body that is driven slowly lags by beta (gamma tau), whatever the frequency
TURNED = ('gravity direction', 'load direction')
ROUND = ('bar', 'tube', 'lobe', 'cube')
# Two branches of relaxation are nearly one; a grip that slips is a clamp that yields for a part of the time.
NEARLY = {'two_branches': {'viscoelasticity', 'viscous_damping', 'mass_damping'}, 'slip': {'elastic_support'}}


def like(effect):
    """The effect, and those that these recordings cannot tell from it."""
    return {effect}.union(*(group for group in EQUIVALENTS if effect in group))


def fits(kind, scene):
    """Whether the body has what is declared wrongly, so that it could be noticed."""
    if kind.startswith('gravity'):
        return any(scene.gravity)
    if kind in ('load gain', 'density', 'time offset'):  # without a measured load E makes up for them, or the clock
        return scene.course is not None
    if kind in ('load zero', 'load direction'):
        return scene.course is not None and scene.load not in ('filling', 'beats')
    return True


def draw_list():
    """All draws, round robin over the classes in proportion, so that any beginning is a fair sample."""
    truths = truth_list()
    of_class = {g: [row for row in truths if row[1] == g] for g in ('clean', 'one', 'two', 'outside')}
    scenes = {row[0]: Scene(row[0], row[2], []) for row in of_class['clean']}
    out = []
    for group, count in COUNTS.items():
        base = of_class[{'declared': 'clean', 'removed': 'one'}.get(group, group)]
        for k in range(count):
            row = base[k % len(base)]
            kind = USUAL[(k + k // len(base)) % len(USUAL)]
            if group == 'clean':
                kind = NOISES[(k + k // len(base)) % len(NOISES)]
            if group == 'declared':
                kind = DECLARED[k % len(DECLARED)]
                able = [row for row in base if fits(kind, scenes[row[0]])]
                row = able[int(len(able) * k / count)]  # the later the draw, the later the truth
            out.append({'place': (k + 0.5) / count, 'class': group, 'kind': kind, 'truth': row[0], 'body': row[2],
                        'hidden': [effect for effect, _ in row[3]]})
    out.sort(key=lambda draw: (draw['place'], draw['class']))
    for number, draw in enumerate(out):
        draw['number'] = number
        del draw['place']
    return out


def honest(draw):
    """For each thing that is wrong, the effects that are an honest name for it; empty: there is none."""
    if draw['class'] == 'declared':
        turned = {'sensor_rotation'} if draw['kind'] in TURNED and draw['body'] in ROUND else set()
        return [CALLED[draw['kind']] | turned]
    if draw['class'] == 'outside':
        return [NEARLY[effect] for effect in draw['hidden'] if effect in NEARLY]
    return [like(effect) for effect in draw['hidden']] if draw['class'] in ('one', 'two') else []


def ignored(draw):
    """What is taken out of the library, so that there is no name for what is hidden."""
    if draw['class'] != 'removed':
        return []
    names = set().union(*(like(effect) for effect in draw['hidden']))
    return sorted(names | (LAGS if names & {'viscous_damping', 'viscoelasticity'} else set()))


def read_truth(folder):
    with open(os.path.join(folder, 'truth.json')) as file:
        truth = json.load(file)
    with open(os.path.join(folder, 'model.yaml')) as file:
        model = yaml.safe_load(file)
    model['mesh']['file'] = os.path.join(folder, model['mesh']['file'])
    with np.load(os.path.join(folder, 'recording.npz')) as arrays:
        return truth, model, dict(arrays)


def noisy(positions, noise, memory, rng):
    e = rng.standard_normal(positions.shape)
    for k in range(1, len(e)):
        e[k] = memory * e[k - 1] + np.sqrt(1 - memory ** 2) * e[k]
    return positions + noise * e


def seen(kind, recording, rng):
    """Rows of the vertices that the sensor sees."""
    rest, count = recording['rest'], len(recording['rest'])
    if kind == 'few sensors':  # such as move
        move = np.abs(recording['positions'] - rest).max(axis=(0, 2))
        return np.sort(rng.choice(np.flatnonzero(move > 0.2 * move.max()), FEW, replace=False))
    if kind == 'half the sensors':
        return np.sort(rng.choice(count, count // 2, replace=False))
    if kind == 'one side':
        corners = rest[recording['triangles']]
        facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = np.zeros_like(rest)
        for corner in range(3):
            np.add.at(normals, recording['triangles'][:, corner], facing)
        return np.flatnonzero(normals @ errors.direction(rng) > 0)
    return np.arange(count)


def observe(kind, truth, recording, rng):
    """Puts the sensor's noise into the recording; returns the noise that is stated."""
    stated, actual = truth['noise'], truth['noise']
    if kind == 'stated too small':
        stated /= MISSTATED
    elif kind == 'stated too large':
        stated *= MISSTATED
    positions = noisy(recording['positions'], actual, MEMORY if kind == 'correlated' else 0.0, rng)
    if kind.endswith('outliers'):
        wild = rng.random(positions.shape[:2]) < float(kind.split()[0]) / 100
        positions[wild] += OUTLIER * actual * rng.standard_normal((wild.sum(), 3))
    rows = seen(kind, recording, rng)
    recording['positions'], recording['vertices'] = positions[:, rows], recording['vertices'][rows]
    return stated


def across(load, rng):
    """A direction across the load's largest value."""
    most = load[np.argmax(np.linalg.norm(load, axis=1))]
    v = np.cross(most, errors.direction(rng))
    return v / np.linalg.norm(v)


def misdeclare(draw, model, recording, rng):
    """Makes the model file or a sensor's calibration wrong."""
    kind, body = draw['kind'], draw['body']
    load, sign = recording['load'], rng.choice((-1.0, 1.0))
    if kind == 'density':
        errors.of_effect(model, 'inertia')[0]['density'] *= 1.3
    elif kind == 'poisson':
        errors.of_effect(model, 'elasticity')[0]['poisson_ratio'] = float(rng.choice((0.3, 0.36)))
    elif kind.startswith('gravity'):
        gravity = errors.of_effect(model, 'gravity')[0]
        g = np.array(gravity['acceleration'])
        turn = Rotation.from_rotvec(np.radians(rng.uniform(10, 40)) * across(g[None], rng)).as_matrix()
        g = turn @ g if kind == 'gravity direction' else g * rng.choice((0.7, 1.4))
        gravity['acceleration'] = [float(x) for x in g]
    elif kind == 'load gain':
        recording['load'] = load * (0.8 if sign < 0 else 1.25)
    elif kind == 'load zero':
        recording['load'] = errors.wrong_load('bias', 0.2, recording['load_time'], load, rng)
    elif kind == 'load direction':
        recording['load'] = load @ Rotation.from_rotvec(np.radians(15) * across(load, rng)).as_matrix().T
    elif kind == 'time offset':
        recording['time'] = recording['time'] + rng.uniform(1, 2) * recording['time'][1]
    elif kind == 'image scale':
        recording['positions'] = recording['positions'] * 1.06
    elif kind == 'clamp too large':
        model['regions']['clamp'] = bodies.clamp(body, reach=0.15 * length_of(body))
    elif kind == 'clamp too small':
        model['regions']['clamp'] = bodies.clamp(body, part=0.55)


def length_of(body):
    axis, _ = bodies.held_axis(body)
    return bodies.BODIES[body]['high'][axis] - bodies.BODIES[body]['low'][axis]


def write_bag(path, recording):
    fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate('xyz')]
    fields.append(PointField('vertex', 12, PointField.UINT32, 1))
    with rosbag.Bag(path, 'w') as bag:
        for k, (t, points) in enumerate(zip(recording['time'], recording['positions'])):
            header = simulate_header(k, genpy.Time.from_sec(START + t))
            rows = [(*map(float, p), int(v)) for p, v in zip(points, recording['vertices'])]
            bag.write('/tissue/vertices', point_cloud2.create_cloud(header, fields, rows), header.stamp)
        for k, (t, value) in enumerate(zip(recording['load_time'], recording['load'])):
            header = simulate_header(k, genpy.Time.from_sec(START + t))
            if len(value) == 3:
                bag.write('/tool/wrench', wrench(header, value), header.stamp)
            elif len(value) == 1:
                bag.write('/tissue/pressure', FluidPressure(header=header, fluid_pressure=value[0]), header.stamp)


def wrench(header, force):
    message = WrenchStamped(header=header)
    message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = force
    return message


def state_prior_and_noise(model, truth, noise, rng):
    """Puts a prior of E and the sensor's stated noise into the model."""
    prior = {'prior': float(truth['young_modulus'][0] * rng.choice(STARTS)), 'factor': 3.0}
    errors.of_effect(model, 'elasticity')[0]['young_modulus'] = prior
    model['observations'] = [{'vertices': {'topic': '/tissue/vertices', 'noise': float(noise)}}]


def write_draw(draw, truth_folder, folder):
    """model.yaml and recording.bag of a draw; returns the truth."""
    rng = np.random.default_rng(7000 + draw['number'])
    truth, model, recording = read_truth(truth_folder)
    noise = observe('stated' if draw['class'] == 'declared' else draw['kind'], truth, recording, rng)
    if draw['class'] == 'declared':
        misdeclare(draw, model, recording, rng)
    state_prior_and_noise(model, truth, noise, rng)
    errors.write_yaml(os.path.join(folder, 'model.yaml'), model)
    write_bag(os.path.join(folder, 'recording.bag'), recording)
    return truth
