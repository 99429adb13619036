"""Errors of inputs: what a wrong sensor makes of a recording, and what a wrong number makes of a model file."""
import copy
import os

import numpy as np
import rosbag
import sensor_msgs.point_cloud2 as point_cloud2
import yaml
from scipy.spatial.transform import Rotation

LOADS = ('gain', 'bias', 'drift', 'noise', 'delay', 'hysteresis', 'direction')
CONSTANTS = {'density': 0.04, 'poisson_ratio': 0.01, 'gravity': 0.1, 'mesh_scale': 0.005, 'pose_rotation': 0.003,
             'pose_offset': 1.0}  # the default tolerances; the last in standard deviations of the noise
CORRELATION_TIME = 0.5  # s, of a load's noise
LONGEST_DELAY = 0.1     # s, at level 1
TOLERANCES = {'gain': 0.1, 'bias': 0.1, 'noise': 0.02, 'hysteresis': 0.03, 'delay': 0.1, 'direction': 0.05}  # as levels


def direction(rng):
    v = rng.standard_normal(3)
    return v / np.linalg.norm(v)


def slow_noise(times, rng, components):
    """Ornstein-Uhlenbeck of standard deviation 1."""
    out = np.empty((len(times), components))
    out[0] = rng.standard_normal(components)
    for k in range(1, len(times)):
        a = np.exp(-(times[k] - times[k - 1]) / CORRELATION_TIME)
        out[k] = a * out[k - 1] + np.sqrt(1 - a * a) * rng.standard_normal(components)
    return out


def wrong_load(kind, level, times, load, rng):
    """What a sensor with this error reads; `level` is a share of the load. A row for each time."""
    rms, most = np.sqrt((load ** 2).sum(axis=1).mean()), np.linalg.norm(load, axis=1).max()
    components = load.shape[1]
    sign = rng.choice((-1.0, 1.0))
    along = direction(rng) if components == 3 else np.array([sign])
    if kind == 'gain':
        return load * (1.0 + sign * level)
    if kind == 'bias':
        return load + level * rms * along
    if kind == 'drift':
        return load + level * rms * np.outer((times - times[0]) / (times[-1] - times[0]), along)
    if kind == 'noise':
        return load + level * rms / np.sqrt(components) * slow_noise(times, rng, components)
    if kind == 'delay':
        late = times - sign * level * LONGEST_DELAY
        return np.stack([np.interp(late, times, column) for column in load.T], axis=1)
    if kind == 'hysteresis':
        change = np.gradient(load, times, axis=0)
        size = np.linalg.norm(change, axis=1, keepdims=True)
        return load + level * most * change / np.maximum(size, 1e-3 * size.max())
    if kind == 'direction':
        return load @ Rotation.from_rotvec(level * direction(rng)).as_matrix().T if components == 3 else load
    raise ValueError(kind)


def typical_load(times, load, rng):
    """Every error at once, each as large as its default tolerance has it."""
    for kind, tolerance in TOLERANCES.items():
        load = wrong_load(kind, tolerance * abs(rng.standard_normal()), times, load, rng)
    return load


def read_load(message):
    if hasattr(message, 'wrench'):
        return [message.wrench.force.x, message.wrench.force.y, message.wrench.force.z]
    return [message.fluid_pressure]


def write_load(message, value):
    if hasattr(message, 'wrench'):
        message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = value
    else:
        message.fluid_pressure = value[0]


def is_load(message):
    return hasattr(message, 'wrench') or hasattr(message, 'fluid_pressure')


def moved_cloud(message, move, noise, rng):
    points = np.array(list(point_cloud2.read_points(message)))
    points[:, :3] = move(points[:, :3]) + (noise * rng.standard_normal((len(points), 3)) if noise else 0.0)
    rows = [tuple(row[:3]) + tuple(int(v) for v in row[3:]) for row in points]
    return point_cloud2.create_cloud(message.header, message.fields, rows)


def rewrite(source, target, change_load=None, move=None, noise=0.0, rng=None):
    """Copies a recording with its loads, point clouds and noise changed."""
    with rosbag.Bag(source) as bag:
        entries = [(topic, copy.deepcopy(message), stamp) for topic, message, stamp in bag.read_messages()]
    for topic in {topic for topic, message, _ in entries if is_load(message)} if change_load else ():
        messages = [message for name, message, _ in entries if name == topic]
        times = np.array([message.header.stamp.to_sec() for message in messages])
        for message, value in zip(messages, change_load(times, np.array([read_load(m) for m in messages]))):
            write_load(message, value)
    with rosbag.Bag(target, 'w') as bag:
        for topic, message, stamp in entries:
            if (move or noise) and type(message).__name__.endswith('PointCloud2'):
                message = moved_cloud(message, move or (lambda x: x), noise, rng)
            bag.write(topic, message, stamp)


def of_effect(model, name):
    return [entry[name] for entry in model['effects'] if name in entry]


def scaled_mesh(model, folder, factor):
    """Writes the mesh's file and regions that much larger, in the model's place."""
    source = model['mesh']['file']
    target = os.path.join(folder, 'scaled' + os.path.splitext(source)[1])
    with open(source) as file:
        lines = file.read().split('\n')
    points = 0
    for i, line in enumerate(lines):
        words = line.split()
        if words[:1] == ['POINTS']:
            points = 3 * int(words[1])
        elif points > 0:
            lines[i] = ' '.join('%.9g' % (factor * float(word)) for word in words)
            points -= len(words)
        elif words[:1] == ['v']:
            lines[i] = 'v ' + ' '.join('%.9g' % (factor * float(word)) for word in words[1:4])
    with open(target, 'w') as file:
        file.write('\n'.join(lines))
    model['mesh']['file'] = target
    for region in model.get('regions', {}).values():
        for shape in region.values():
            for key, value in shape.items() if isinstance(shape, dict) else ():
                if key != 'normal':
                    shape[key] = [factor * v for v in value] if isinstance(value, list) else factor * value
    for observation in model['observations']:
        for sensor in observation.values():
            if 'rest' in sensor:
                sensor['rest'] = [[factor * x for x in point] for point in sensor['rest']]


def wrong_constant(kind, sigmas, model, folder, rng):
    """Changes the model by so many default tolerances; returns how the sensor's points move, or None."""
    size = float(sigmas * CONSTANTS[kind] * rng.choice((-1.0, 1.0)))
    if kind == 'density':
        of_effect(model, 'inertia')[0]['density'] *= 1.0 + size
    elif kind == 'poisson_ratio':
        ratio = of_effect(model, 'elasticity')[0]
        ratio['poisson_ratio'] = min(0.495, ratio['poisson_ratio'] + size)
    elif kind == 'gravity':
        for gravity in of_effect(model, 'gravity'):
            gravity['acceleration'] = [float(v) for v in np.array(gravity['acceleration']) + size * direction(rng)]
    elif kind == 'mesh_scale':
        scaled_mesh(model, folder, 1.0 + size)
    elif kind == 'pose_rotation':
        turn = Rotation.from_rotvec(size * direction(rng)).as_matrix()
        return lambda points: (points - points.mean(axis=0)) @ turn.T + points.mean(axis=0)
    elif kind == 'pose_offset':
        noise = next(iter(model['observations'][0].values()))['noise']
        shift = size * noise * direction(rng)
        return lambda points: points + shift
    return None


def write_yaml(path, content):
    with open(path, 'w') as file:
        yaml.safe_dump(content, file, default_flow_style=None, sort_keys=False)
    return path
