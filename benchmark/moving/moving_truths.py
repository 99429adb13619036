"""Truths of the independent simulator in which a region follows a rigid body: an indentation with a bonded punch, a
retraction by a grasp, a base that shakes. `draw(simulator, kind, seed)` returns what a laboratory would have recorded."""
import copy
import logging
import sys

import numpy as np
from scipy.spatial.transform import Rotation

import foreign_bodies as bodies
from smooth_course import smooth

DENSITY, POISSON = 1060.0, 0.45
FIRM = 3e4          # times the body's stiffness: springs by which a region follows
FPS, FRAMES = 50.0, 60
POSE_RATE = 200.0   # Hz
POSE_NOISE = {'indentation': 2e-6, 'retraction': 2e-5, 'shaken base': 2e-5}  # m: of a linear stage, and of an arm
FORCE_NOISE = 0.01  # of the largest force
POINT_NOISE = 2e-4  # m
STEP = 0.002        # s
KINDS = {'indentation': ('cube', 'slab', 'lobe', 'plate'), 'retraction': ('bar', 'slab', 'plate', 'bar'),
         'shaken base': ('bar', 'plate', 'slab', 'lobe')}
MODULUS = (8e3, 60e3)


def gripped_sim(simulate):
    """The simulator's class with regions that follow a rigid motion by springs of its own."""
    class Gripped(bodies.extend(simulate)):
        def __init__(self, config, extra):
            self.guides, self.forces = [], []
            super().__init__(config, extra)
            for inside, motion in extra.get('guides', []):
                whole, free = self.spring_on(inside)
                area = whole.sum() / 3.0
                firm = FIRM * extra['modulus'] / np.sqrt(area)
                self.springs.append([whole, free, lambda t, firm=firm: firm])
                self.guides.append((whole, firm, motion))

        def way(self, motion, t):
            shift, turn = motion(t)
            return (self.X @ (Rotation.from_rotvec(turn).as_matrix() - np.eye(3)).T + shift).ravel()

        def _rint(self):
            r = super()._rint()
            for whole, firm, motion in self.guides:
                r -= firm * (whole @ self.way(motion, self.now))
            return r

        def step(self, dt, depth=0):
            """The step balances its forces within it; stiff springs ring between its ends."""
            before = self.un.x.array.copy()
            super().step(dt, depth)
            middle = (1 - self.af) * self.un.x.array + self.af * before
            self.forces = [[firm * (whole @ (self.way(motion, self.t - self.af * dt) - middle)).reshape(-1, 3).sum(axis=0)
                            for whole, firm, motion in self.guides]] + self.forces[:1]

        def reaction(self):
            """Force [N] on the region that follows, extrapolated to the end of the last step."""
            if len(self.forces) < 2:
                return np.zeros(3)
            last, before = self.forces
            return last[0] + self.af * (last[0] - before[0])
    return Gripped


def in_region(region):
    """A predicate over points: the facets of a region of the model file."""
    if 'sphere' in region:
        ball = region['sphere']
        return lambda x: np.linalg.norm(x - np.array(ball['center']), axis=1) < ball['radius']
    low, high = (np.array(region['box'][k]) for k in ('min', 'max'))
    return lambda x: np.all((x >= low) & (x <= high), axis=1)


class Truth:
    def __init__(self, kind, seed, one_modulus=False):
        self.rng = rng = np.random.default_rng([ord(c) for c in kind] + [seed])
        self.kind, self.body = kind, KINDS[kind][seed % len(KINDS[kind])]
        low, high = (np.array(bodies.BODIES[self.body][k], float) for k in ('low', 'high'))
        self.length = float(max(high - low))
        self.modulus = float(np.exp(rng.uniform(*np.log(MODULUS))))
        self.ratio = float(rng.choice((0.4, 0.6, 1.7, 2.5))) if kind == 'retraction' else 1.0
        if one_modulus:
            self.ratio = 1.0
        self.axis, self.foot = bodies.held_axis(self.body)
        self.middle = float(0.5 * (self.foot + high[self.axis]))
        self.regions = {'clamp': bodies.clamp(self.body), 'tool': bodies.end_of(self.body)[0]}
        self.motion = getattr(self, kind.split()[0])()

    def indentation(self):
        along = np.zeros(3)
        along[self.axis] = -1.0
        way = smooth([0.05, 0.4, 0.6, 0.9, 1.2], self.length * self.rng.uniform(0.02, 0.05) * np.array([0, 1, 0.6, 1.1, 0.2]))
        along += 0.15 * self.rng.standard_normal(3)
        return lambda t: (way(t) * along, np.zeros(3))

    def retraction(self):
        direction = self.rng.standard_normal(3)
        direction[self.axis] = 0.5 + abs(direction[self.axis])
        direction /= np.linalg.norm(direction)
        turn = 0.08 * self.rng.standard_normal(3)
        way = smooth([0.05, 0.5, 0.8, 1.2], np.array([0, 1, 0.7, 1.2]))
        size = 0.05 * self.length
        return lambda t: (way(t) * size * direction, way(t) * turn)

    def shaken(self):
        direction = self.rng.standard_normal(3)
        direction[self.axis] *= 0.2
        direction /= np.linalg.norm(direction)
        freq = self.rng.uniform(1.0, 2.5)
        self.shake = {'size': 0.012, 'freq': freq, 'direction': [float(x) for x in direction]}
        return lambda t: (0.5 * self.shake['size'] * (1 - np.cos(2 * np.pi * freq * t)) * direction, np.zeros(3))

    def config(self, simulate, step):
        c = copy.deepcopy(simulate.DEFAULTS)
        simulate.deep_update(c, {'body': bodies.BODIES[self.body]['body'],
                                 'material': {'model': 'linear', 'E': self.modulus, 'nu': POISSON, 'rho': DENSITY},
                                 'time': {'fps': FPS, 'frames': FRAMES, 'substeps': int(np.ceil(1 / FPS / step))}})
        if self.ratio != 1.0:  # a ball so large that its border is flat
            center = [0.0, 0.0, 0.0]
            center[self.axis] = self.middle + bodies.FAR
            c['inclusions'] = [{'center': center, 'radius': bodies.FAR, 'ratio': self.ratio}]
        return c

    def run(self, simulate, sim, step):
        c = self.config(simulate, step)
        extra = {'modulus': self.modulus}
        if self.kind == 'shaken base':
            extra['shake'] = self.shake
        else:
            extra['guides'] = [(in_region(self.regions['tool']), self.motion)]
        nodes, tets = simulate.linear_mesh(c, float(c['body']['h_obs']))
        surface = np.unique(simulate.surf_linear(nodes, tets))
        body = sim(c, extra)
        to_surface, _ = simulate.p2_interp_matrix(body.X, body.cells, nodes[surface])
        body.init_accel()
        positions, forces, whole = [], [], []
        for k in range(FRAMES):
            for _ in range(c['time']['substeps'] if k else 0):
                body.step(1.0 / FPS / c['time']['substeps'])
            body.t = k / FPS
            shift = self.motion(body.t)[0] if 'shake' in extra else 0.0
            positions.append(nodes[surface] + to_surface @ body.u.x.array.reshape(-1, 3) + shift)
            forces.append(body.reaction() if body.guides else np.zeros(3))
            whole.append(body.u.x.array.reshape(-1, 3) + shift)
        self.film = {'time': np.arange(FRAMES) / FPS, 'X': body.X, 'cells': body.cells,
                     'surf6': simulate.surface_p2(body.cells, body.X), 'U': np.array(whole)}
        return nodes, tets, surface, np.array(positions), np.array(forces)


def draw(simulator, kind, seed, one_modulus=False):
    sys.path.insert(0, simulator)
    logging.disable(logging.INFO)
    import simulate
    truth = Truth(kind, seed, one_modulus)
    sim = gripped_sim(simulate)
    nodes, tets, surface, coarse, coarse_forces = truth.run(simulate, sim, STEP)
    _, _, _, fine, fine_forces = truth.run(simulate, sim, 0.5 * STEP)
    return truth, nodes, tets, surface, (4 * fine - coarse) / 3, (4 * fine_forces - coarse_forces) / 3
