"""Truths of the independent simulator: bodies, loads, what is hidden in them, how strong. `python3 foreign_truths.py
SIMULATOR NAME FOLDER` simulates one: the recording without noise, its mesh, and the model that is right but for what is
hidden. `--check` in place of the folder says what half the time step and smaller elements change."""
import copy
import json
import logging
import os
import sys
import time

import numpy as np
import yaml

import foreign_bodies as bodies
from foreign import DENSITY, LOAD_RATE

POISSON = 0.45
MODULUS = {'bar': (8e3, 300e3), 'slab': (8e3, 200e3), 'plate': (8e3, 200e3), 'cube': (8e3, 50e3), 'lobe': (8e3, 50e3),
           'tube': (8e3, 150e3), 'lv': (8e3, 150e3)}  # Pa; stout bodies ring fast where they are stiff
MOTION = (0.01, 0.025)          # rms over the body's length
MOTION_OVER_NOISE = (4.0, 20.0)
NOISE = (1e-4, 6e-4)            # m, rms of a coordinate
STEP, LONG_STEP = 0.001, 0.003  # s, of small and finite strain; a truth is extrapolated from it and its half
SHORTER = 0.03                  # of the motion: where the half step changes more, a finite strain takes shorter steps
TRIALS = 3                      # of a hidden effect's strength
CLOSE = (0.65, 1.5)             # moves the body so many times as far as it should: near enough
WORST = 0.4                     # displacement over length beyond which a body is not bent
LEVELS = (0.1, 0.3, 0.03)       # of the motion
EFFECTS = ['viscous_damping', 'stiff_inclusion', 'viscoelasticity', 'elastic_support', 'gravity', 'mass_damping',
           'added_mass', 'foundation', 'fibre_reinforcement', 'geometric_nonlinearity', 'active_contraction']
PAIRS = [('viscous_damping', 'elastic_support'), ('mass_damping', 'stiff_inclusion'), ('viscoelasticity', 'gravity'),
         ('added_mass', 'viscous_damping'), ('foundation', 'viscoelasticity'), ('gravity', 'elastic_support'),
         ('fibre_reinforcement', 'viscous_damping'), ('active_contraction', 'mass_damping'),
         ('stiff_inclusion', 'gravity'), ('geometric_nonlinearity', 'viscous_damping'),
         ('added_mass', 'elastic_support'), ('foundation', 'gravity'), ('viscoelasticity', 'elastic_support'),
         ('fibre_reinforcement', 'gravity'), ('mass_damping', 'elastic_support'), ('viscous_damping', 'gravity'),
         ('stiff_inclusion', 'viscoelasticity'), ('added_mass', 'gravity')]
OUTSIDE = ['push', 'breathing', 'slip', 'modulus_jump', 'two_branches']
BODY_ORDER = ['bar', 'lv', 'lobe', 'cube', 'tube', 'slab', 'plate']
LOADS = {'bar': ['chirp', 'release', 'pluck', 'hold'], 'slab': ['hold', 'chirp', 'pluck'],
         'plate': ['pluck', 'sines', 'release'],
         'cube': ['chirp', 'hold', 'sines'], 'lv': ['filling', 'beats'], 'tube': ['filling', 'sines', 'beats'],
         'lobe': ['hold', 'chirp', 'pluck', 'sines']}
PRESSURES = ('filling', 'beats')
WEIGHED = 0.4                   # share of the pushed bodies that gravity acts on, too


def truth_list():
    """(name, class, body, hidden [(effect, share of the motion)]): any beginning is a fair sample."""
    groups = {'clean': [[] for _ in range(16)],
              'one': [[(EFFECTS[k % len(EFFECTS)], LEVELS[(k // len(EFFECTS) + k) % 3])] for k in range(33)],
              'two': [[(effect, LEVELS[(k + i) % 2]) for i, effect in enumerate(pair)] for k, pair in enumerate(PAIRS)],
              'outside': [[(OUTSIDE[k % len(OUTSIDE)], LEVELS[k // len(OUTSIDE) % 2])] for k in range(20)]}
    out = []
    for shift, (group, hidden) in enumerate(groups.items()):
        for k, what in enumerate(hidden):
            body = BODY_ORDER[(k + 2 * shift + k // len(BODY_ORDER)) % len(BODY_ORDER)]
            if any(effect == 'active_contraction' for effect, _ in what):
                body = ('lv', 'tube')[k % 2]
            name = '_'.join([group, '%02d' % k, body] + [effect for effect, _ in what])
            out.append(((k + 0.5) / len(hidden), name, group, body, what))
    return [row[1:] for row in sorted(out)]


def scaled(course, factor):
    out = {k: factor * v if k in ('amp', 'v0', 'v1', 'offset', 'value') else v for k, v in course.items()}
    if 'terms' in out:
        out['terms'] = [scaled(term, factor) for term in out['terms']]
    if 'v' in out:
        out['v'] = [factor * v for v in out['v']]
    return out


def course_of(kind, duration, rng):
    """A load's course, about one high."""
    if kind == 'chirp':
        return {'type': 'chirp', 'amp': 1.0, 'f0': rng.uniform(0.5, 1), 'f1': rng.uniform(3, 6), 'T': duration}
    if kind == 'hold':
        return {'type': 'sum', 'terms': [{'type': 'ramp', 't0': 0.05, 't1': rng.uniform(0.2, 0.5), 'v0': 0, 'v1': 1.0},
                                         {'type': 'sine', 'amp': 0.5, 'freq': rng.uniform(1.5, 3), 'soft': 0.3}]}
    if kind == 'sines':
        return {'type': 'sum', 'terms': [{'type': 'sine', 'amp': 0.7, 'freq': f, 'phase': 0.0, 'soft': 0.2}
                                         for f in (rng.uniform(0.6, 1.2), rng.uniform(2, 4))]}
    if kind == 'pluck':
        until = rng.uniform(0.25, 0.45)
        return {'type': 'table', 't': [0, until - 0.1, until, until + 0.06], 'v': [0, 1, 1, 0]}
    if kind == 'filling':
        return {'type': 'raised', 'amp': 1.0, 'freq': rng.uniform(1.0, 2.2)}
    return {'type': 'cardiac', 'amp': 1.0, 'period': rng.uniform(0.55, 0.8), 't0': 0.08, 'rise': 0.14, 'fall': 0.18,
            'hold': 0.05}


def unit(v):
    return [float(x) for x in np.array(v, float) / np.linalg.norm(v)]


class Scene:
    """One body under one load, before anything is hidden in it."""

    def __init__(self, name, body, hidden):
        self.rng = rng = np.random.default_rng([ord(c) for c in name])
        self.body = body
        self.length = max(np.subtract(bodies.BODIES[body]['high'], bodies.BODIES[body]['low']))
        self.fps, self.frames = float(rng.choice((30, 40, 50))), int(rng.integers(42, 60))
        self.duration = (self.frames - 1) / self.fps
        kinds = LOADS[body]
        if any(effect == 'gravity' for effect, _ in hidden):  # nobody told of it: something else must be known
            kinds = [kind for kind in kinds if kind != 'release']
        self.load = str(rng.choice(kinds))
        self.modulus = float(np.exp(rng.uniform(*np.log(MODULUS[body]))))
        self.gravity = [0.0, 0.0, 0.0]
        self.course, self.direction, self.factor, self.stretch = None, None, 1.0, 1.0
        if self.load == 'release':  # a soft one would bend too far
            self.modulus = float(MODULUS[body][1] * rng.uniform(0.5, 1.0))
        else:
            self.course = course_of(self.load, self.duration, rng)
            self.direction = self.push_direction()
        told = not any(effect == 'gravity' for effect, _ in hidden) and self.load not in PRESSURES
        if self.load == 'release' or (told and rng.random() < WEIGHED):
            self.gravity = [float(9.81 * x) for x in unit(rng.standard_normal(3) + 2 * self.across())]

    def across(self):
        """Some direction across the axis along which the body stands out."""
        axis, _ = bodies.held_axis(self.body)
        v = self.rng.standard_normal(3)
        v[axis] = 0.0
        return v / np.linalg.norm(v)

    def push_direction(self):
        axis, _ = bodies.held_axis(self.body)
        along = np.zeros(3)
        along[axis] = self.rng.uniform(-0.9, -0.2)
        return unit(self.across() * self.rng.uniform(0.5, 1.0) + along)

    def nominal(self):
        """Force that is like the body's weight, or a pressure that is like its stiffness, for a start."""
        return 0.02 * self.modulus if self.load in PRESSURES else 0.002 * self.modulus

    def config(self, simulate, step):
        c = copy.deepcopy(simulate.DEFAULTS)
        fine = int(np.ceil(1.0 / self.fps / step))
        simulate.deep_update(c, {'body': bodies.BODIES[self.body]['body'],
                                 'material': {'model': 'linear', 'E': self.modulus, 'nu': POISSON, 'rho': DENSITY},
                                 'time': {'fps': self.fps, 'frames': self.frames, 'substeps': fine}})
        strength = self.factor * self.stretch
        if self.course and self.load in PRESSURES:
            c['pressure'] = scaled(self.course, strength * self.nominal())
        elif self.course:
            c['patch'] = dict(bodies.end_of(self.body)[1], direction=self.direction, edge=bodies.LOAD_SPREAD,
                              course=scaled(self.course, strength * self.nominal()))
        self.add_gravity(c, strength * np.array(self.gravity))
        return c, {'name': self.body}

    @staticmethod
    def add_gravity(c, acceleration):
        whole = c['gravity']['g'] * np.array(c['gravity']['direction'], float) + acceleration
        size = float(np.linalg.norm(whole))
        c['gravity'] = {'g': size, 'direction': unit(whole) if size > 0 else [0, 0, -1]}


class Hidden:
    """An effect in a scene: where it sits, and how it goes into the simulator's settings at strength s."""

    def __init__(self, effect, scene):
        self.effect, self.scene, rng = effect, scene, scene.rng
        low, high = (np.array(bodies.BODIES[scene.body][k], float) for k in ('low', 'high'))
        self.axis, self.foot = bodies.held_axis(scene.body)
        self.low, self.high = low, high
        self.tau = float(rng.uniform(0.05, 0.25))
        self.along = unit(rng.standard_normal(3))
        self.across = [float(x) for x in scene.across()]
        self.time = round(rng.uniform(0.3, 0.6) * scene.frames) / scene.fps  # between two steps, however long they are
        self.sign = float(rng.choice((-1.0, 1.0)))
        self.freq = float(rng.uniform(0.6, 1.8))
        self.place = self.inside(rng.uniform(0.25, 0.5), rng)
        self.far_place = self.inside(rng.uniform(0.8, 1.0), rng)

    def inside(self, height, rng):
        """A point at that share of the body's length from its clamp; in the wall where the body is hollow."""
        point = 0.5 * (self.low + self.high) + 0.3 * (self.high - self.low) * rng.uniform(-0.5, 0.5, 3)
        tip = self.low[self.axis] if self.scene.body == 'lv' else self.high[self.axis]
        point[self.axis] = self.foot + height * (tip - self.foot)
        if self.scene.body in ('lv', 'tube'):
            turn = rng.uniform(0, 2 * np.pi)
            narrow = np.sqrt(max(0.1, 1 - (point[2] / 0.06) ** 2)) if self.scene.body == 'lv' else 1.0
            wall = 0.8 * self.high[0] * narrow
            point[:2] = wall * np.cos(turn), wall * np.sin(turn)
        return [float(x) for x in point]

    def start(self):
        """A strength to begin with."""
        modulus, length = self.scene.modulus, self.scene.length
        return {'viscous_damping': 0.005, 'mass_damping': 3.0, 'viscoelasticity': 0.3, 'stiff_inclusion': 2.0,
                'elastic_support': 0.02 * length / modulus, 'added_mass': 0.1, 'gravity': 0.5,
                'fibre_reinforcement': 0.5 * modulus, 'geometric_nonlinearity': 2.0,
                'active_contraction': 0.02 * modulus, 'foundation': 0.1 * modulus / length,
                'push': 1e-4 * modulus * length ** 2, 'breathing': 0.002, 'slip': 0.05 * length / modulus,
                'modulus_jump': 0.3, 'two_branches': 0.2}[self.effect]

    def most(self):
        return {'stiff_inclusion': 30.0, 'viscoelasticity': 5.0, 'modulus_jump': 2.0, 'added_mass': 2.0,
                'two_branches': 3.0, 'geometric_nonlinearity': 12.0, 'gravity': 15.0}.get(self.effect, np.inf)

    def put(self, c, extra, s):
        effect, scene = self.effect, self.scene
        if effect == 'viscous_damping':
            c['damping']['kelvin_voigt'] = s
        elif effect == 'mass_damping':
            c['damping']['mass'] = s
        elif effect == 'viscoelasticity':
            c['viscoelastic'] = {'gamma': s, 'tau': self.tau}
        elif effect == 'stiff_inclusion':
            radius = 0.35 * min(self.high - self.low)
            c['inclusions'] = [{'center': self.place, 'radius': float(radius), 'ratio': 1.0 + s}]
        elif effect == 'elastic_support':
            c['boundary'] = {'type': 'spring', 'k': 1.0 / s, 'c': 0.0}
        elif effect == 'added_mass':  # of a bar's mass, or what it is of the others
            radius = 0.2 * min(self.high - self.low)
            c['added_mass'] = [{'center': self.far_place, 'radius': radius, 'mass': 0.05 * s}]
        elif effect == 'gravity':
            scene.add_gravity(c, s * np.array(self.along))
        elif effect == 'fibre_reinforcement':
            c['fibres'] = {'direction': 'circumferential' if scene.body == 'lv' else self.along, 'stiffness': s}
        elif effect == 'geometric_nonlinearity':
            c['material']['model'] = 'neo_hookean'
        elif effect == 'active_contraction':
            c['active'] = {'direction': 'circumferential', 'course': {'type': 'raised', 'amp': s, 'freq': self.freq}}
        elif effect == 'foundation':
            extra['ground'] = s
        elif effect == 'push':
            times = [0] + [self.time + x for x in (-0.15, 0.0, 0.2, 0.35)]
            extra['pushes'] = [{'center': self.surface_place(), 'radius': 0.015, 'direction': self.across,
                                'course': {'type': 'table', 't': times, 'v': [0, 0, s, s, 0]}}]
        elif effect == 'breathing':
            extra['shake'] = {'size': s, 'freq': self.freq, 'direction': self.along}
        elif effect == 'slip':
            c['boundary'] = {'type': 'spring', 'k': 1.0 / s, 'c': 0.0}
            extra['slip'] = (self.time, 200.0 * scene.modulus / scene.length)
        elif effect == 'modulus_jump':
            extra['jump'] = {'time': self.time, 'ratio': 1.0 + s if self.sign > 0 else 1.0 / (1.0 + s)}
        elif effect == 'two_branches':
            c['viscoelastic'] = {'gamma': s, 'tau': 0.02}
            extra['branches'] = [(s, 0.4)]

    def surface_place(self):
        middle = 0.5 * (self.low + self.high)
        out = np.array(self.place)
        turn = np.array(self.across)
        out[[i for i in range(3) if i != self.axis]] = middle[[i for i in range(3) if i != self.axis]]
        return [float(x) for x in out - 0.5 * np.abs(turn @ (self.high - self.low)) * turn]


class Simulator:
    def __init__(self, path):
        sys.path.insert(0, path)
        logging.disable(logging.INFO)  # every compiled form says so
        import simulate
        self.simulate = simulate
        self.sim = bodies.extend(simulate)

    def observer(self, c):
        """The mesh that is given away: nodes, tetrahedra, surface nodes and triangles."""
        nodes, tets = self.simulate.linear_mesh(c, float(c['body']['h_obs']))
        triangles = self.simulate.surf_linear(nodes, tets)
        return nodes, tets, np.unique(triangles), triangles

    def run(self, c, extra):
        """Displacements of the surface's nodes, frame by frame, and the area that is pushed."""
        nodes, _, surface, _ = self.observer(c)
        body = self.sim(c, extra)
        to_surface, _ = self.simulate.p2_interp_matrix(body.X, body.cells, nodes[surface])
        fine, rate = c['time']['substeps'], c['time']['fps']
        body.init_accel()
        out = []
        for k in range(c['time']['frames']):
            for _ in range(fine if k else 0):
                body.step(1.0 / rate / fine)
            body.t = k / rate
            out.append(to_surface @ body.u.x.array.reshape(-1, 3))
            if 'shake' in extra:
                s = extra['shake']
                shift = 0.5 * s['size'] * (1 - np.cos(2 * np.pi * s['freq'] * body.t))
                out[-1] = out[-1] + shift * np.array(s['direction'])
        return np.array(out), getattr(body, 'patch_area', 0.0)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def step_of(effects, step=None):
    return step or (LONG_STEP if 'geometric_nonlinearity' in effects else STEP)


def moved(simulator, scene, hidden, strengths, step=None):
    """With what is hidden; None where the body cannot bear it."""
    c, extra = scene.config(simulator.simulate, step_of([h.effect for h in hidden], step))
    for h, s in zip(hidden, strengths):
        h.put(c, extra, s)
    try:
        out, area = simulator.run(c, extra)
    except (RuntimeError, ValueError):
        return None, 0.0
    return (out, area) if np.abs(out).max() < WORST * scene.length or scene.stretch == 1.0 else (None, 0.0)


def extrapolated(simulator, scene, hidden, strengths, step=None):
    """The same without the second-order error of the time steps, by which an undamped body would ring too slowly. The
    extrapolation holds while that error is small, so long steps are halved until it is."""
    step = step_of([h.effect for h in hidden], step)
    coarse, _ = moved(simulator, scene, hidden, strengths, step)
    while coarse is not None:
        step *= 0.5
        fine, area = moved(simulator, scene, hidden, strengths, step)
        if fine is None:
            break
        if step <= 0.5 * STEP or rms(fine - coarse) < SHORTER * rms(fine):
            return (4 * fine - coarse) / 3, area
        coarse = fine
    return None, 0.0


def find_strength(simulator, scene, h, plain, share):
    """The strength at which the effect moves the body by about `share` of its motion, and by how much it does. Finite
    strain is the stronger the larger the load."""
    s, best = h.start(), None
    for _ in range(TRIALS):
        if h.effect == 'geometric_nonlinearity':
            scene.stretch = s
        out, _ = moved(simulator, scene, [h], [s])
        if out is None:
            s *= 0.5
            continue
        size = rms(out - plain * scene.stretch) / rms(plain * scene.stretch)
        if best is None or abs(np.log(size / share)) < abs(np.log(best[1] / share)):
            best = (s, size)
        if CLOSE[0] < size / share < CLOSE[1] or s == h.most():
            break
        s = float(min(h.most(), s * np.clip(share / size, 0.03, 30.0)))
    if best is None:
        raise RuntimeError('no strength of %s that the body bears' % h.effect)
    if h.effect == 'geometric_nonlinearity':
        scene.stretch = best[0]
    return best


def simulate_truth(path, name, folder):
    begun = time.time()
    _, _, body, what = next(row for row in truth_list() if row[0] == name)
    simulator, scene = Simulator(path), Scene(name, body, what)
    shares = dict(what)
    plain, _ = moved(simulator, scene, [], [], step_of(shares))  # compared with runs of the same steps
    scene.factor = float(scene.rng.uniform(*MOTION) * scene.length / rms(plain))
    if any(scene.gravity):
        scene.factor = min(1.0, scene.factor)
    plain = plain * scene.factor
    hidden = sorted((Hidden(effect, scene) for effect, _ in what), key=lambda h: h.effect != 'geometric_nonlinearity')
    found = [find_strength(simulator, scene, h, plain, shares[h.effect]) for h in hidden]
    positions, area = extrapolated(simulator, scene, hidden, [s for s, _ in found])
    if positions is None:
        raise RuntimeError('the body does not bear ' + ' and '.join(h.effect for h in hidden))
    config, _ = scene.config(simulator.simulate, step_of(shares))
    write_truth(simulator, scene, config, positions, area, folder)
    modulus = [scene.modulus]
    for h, (s, _) in zip(hidden, found):
        if h.effect == 'modulus_jump':
            modulus.append(scene.modulus * (1.0 + s if h.sign > 0 else 1.0 / (1.0 + s)))
    noise = float(np.clip(rms(positions) / np.exp(scene.rng.uniform(*np.log(MOTION_OVER_NOISE))), *NOISE))
    strengths = [{'effect': h.effect, 'strength': float(s), 'share': round(size, 4)}
                 for h, (s, size) in zip(hidden, found)]
    out = {'name': name, 'body': body, 'load': scene.load, 'young_modulus': modulus, 'hidden': strengths,
           'noise': noise, 'motion': rms(positions), 'most': float(np.abs(positions).max()),
           'seconds': round(time.time() - begun, 1)}
    with open(os.path.join(folder, 'truth.json'), 'w') as file:  # last: it says that the rest is there
        json.dump(out, file, indent=1)
    print(json.dumps(out))


def write_truth(simulator, scene, config, moved_by, area, folder):
    """mesh.vtk, recording.npz and the model.yaml that knows all but the hidden."""
    nodes, tets, surface, triangles = simulator.observer(config)
    simulator.simulate.write_vtk_tets(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    times = np.arange(0.0, scene.duration + 1e-9, 1.0 / LOAD_RATE)
    regions = {'clamp': bodies.clamp(scene.body)}
    effects = [{'inertia': {'density': DENSITY}},
               {'elasticity': {'law': 'linear', 'young_modulus': None, 'poisson_ratio': POISSON}},
               {'fixed': {'region': 'clamp'}}]
    load = np.zeros((len(times), 0))
    if config['pressure'] is not None:
        course = simulator.simulate.course(config['pressure'])
        load = np.array([[course(t)] for t in times])
        regions['cavity'] = bodies.cavity(scene.body)
        effects.append({'pressure': {'region': 'cavity', 'topic': '/tissue/pressure'}})
    elif config['patch'] is not None:
        course = simulator.simulate.course(config['patch']['course'])
        load = np.array([area * course(t) * np.array(scene.direction) for t in times])
        regions['end'] = bodies.end_of(scene.body)[0]
        effects.append({'traction': {'region': 'end', 'topic': '/tool/wrench'}})
    if any(scene.gravity):
        effects.append({'gravity': {'acceleration': [float(scene.factor * scene.stretch * g) for g in scene.gravity]}})
    np.savez_compressed(os.path.join(folder, 'recording.npz'), time=np.arange(scene.frames) / scene.fps,
                        vertices=surface, positions=nodes[surface] + moved_by, rest=nodes[surface], load_time=times,
                        load=load, triangles=np.searchsorted(surface, triangles))
    with open(os.path.join(folder, 'model.yaml'), 'w') as file:
        yaml.safe_dump({'mesh': {'file': 'mesh.vtk'}, 'regions': regions, 'effects': effects}, file, sort_keys=False,
                       default_flow_style=None)


def check(path, name):
    """What half the time step, and elements of 0.64 times the size, change: shares of the motion."""
    _, _, body, what = next(row for row in truth_list() if row[0] == name)

    def run(part_of_step):
        simulator, scene = Simulator(path), Scene(name, body, what)
        hidden = [Hidden(effect, scene) for effect, _ in what]
        return extrapolated(simulator, scene, hidden, [h.start() for h in hidden], part_of_step * step_of(dict(what)))[0]

    plain = run(1.0)
    print('%s: half the step changes %.2f %% of the motion' % (name, 100 * rms(run(0.5) - plain) / rms(plain)))
    bodies.BODIES[body]['body']['h'] *= 0.64
    print('%s: smaller elements change %.1f %% of the motion' % (name, 100 * rms(run(1.0) - plain) / rms(plain)))


if __name__ == '__main__':
    if sys.argv[3] == '--check':
        check(*sys.argv[1:3])
    else:
        os.makedirs(sys.argv[3], exist_ok=True)
        simulate_truth(*sys.argv[1:])
