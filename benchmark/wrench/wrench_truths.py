"""Truths of the independent simulator in which a tool presses on the end of a body, beside its middle and at no fixed
place. `draw(simulator, seed)` returns what a laboratory would have recorded: tracked points, and the tool's wrench."""
import copy
import logging
import sys

import numpy as np

import foreign_bodies as bodies

DENSITY, POISSON = 1060.0, 0.45
FPS, FRAMES, STEP = 50.0, 60, 0.002      # Hz, -, s
FORCE_NOISE, POINT_NOISE = 0.01, 2e-4    # of the largest force and torque; m
MODULUS = (8e3, 60e3)                    # Pa
TRAVEL = 0.06                            # largest displacement over the body's length
SENSOR_HEIGHT = 0.04                     # m, of the sensor above the end
SPREAD = 0.004                           # m, radius of what is pressed
BODIES = ('bar', 'slab', 'plate', 'cube')


class Truth:
    def __init__(self, seed):
        self.rng = rng = np.random.default_rng([11, seed])
        self.body = BODIES[seed % len(BODIES)]
        self.modulus = float(np.exp(rng.uniform(*np.log(MODULUS))))
        self.axis, _ = bodies.held_axis(self.body)
        self.low, self.high = (np.array(bodies.BODIES[self.body][k], float) for k in ('low', 'high'))
        self.regions = {'clamp': bodies.clamp(self.body), 'tool': bodies.end_of(self.body)[0]}
        self.pushes = [self.push(side) for side in (1.0, -1.0)]
        self.sensor = np.zeros(3)
        self.sensor[self.axis] = self.high[self.axis] + SENSOR_HEIGHT

    def push(self, side):
        """A force at its own rate on a place of its own, off the middle on this side."""
        share = self.rng.uniform(0.4, 0.8, 3) * np.array([1.0, side, self.rng.choice((-1.0, 1.0))])
        center = 0.5 * (self.low + self.high) + 0.5 * share * (self.high - self.low)
        center[self.axis] = self.high[self.axis]
        direction = self.rng.standard_normal(3)
        direction[self.axis] *= 2.0
        return {'center': center, 'radius': SPREAD, 'direction': direction,
                'course': {'type': 'raised', 'amp': self.rng.uniform(0.5, 1.0), 'freq': self.rng.uniform(0.8, 2.0)}}

    def run(self, simulate, sim, step):
        c = copy.deepcopy(simulate.DEFAULTS)
        simulate.deep_update(c, {'body': bodies.BODIES[self.body]['body'],
                                 'material': {'model': 'linear', 'E': self.modulus, 'nu': POISSON, 'rho': DENSITY},
                                 'time': {'fps': FPS, 'frames': FRAMES, 'substeps': int(np.ceil(1 / FPS / step))}})
        nodes, tets = simulate.linear_mesh(c, float(c['body']['h_obs']))
        surface = np.unique(simulate.surf_linear(nodes, tets))
        body = sim(c, {'pushes': self.pushes})
        to_surface, _ = simulate.p2_interp_matrix(body.X, body.cells, nodes[surface])
        body.init_accel()
        moved, wrenches = [], []
        for k in range(FRAMES):
            for _ in range(c['time']['substeps'] if k else 0):
                body.step(1.0 / FPS / c['time']['substeps'])
            body.t = k / FPS
            moved.append(to_surface @ body.u.x.array.reshape(-1, 3))
            wrenches.append(sum(course(body.t) * self.wrench_of(body.X, forces) for forces, course in body.pushes))
        return nodes, tets, surface, np.array(moved), np.array(wrenches)

    def wrench_of(self, places, nodal):
        """Force [N], and torque about the sensor [N m]."""
        forces = nodal.reshape(-1, 3)
        return np.hstack([forces.sum(axis=0), np.cross(places - self.sensor, forces).sum(axis=0)])


def draw(simulator, seed):
    """The body is linear, so its motion is scaled to the wanted travel."""
    sys.path.insert(0, simulator)
    logging.disable(logging.INFO)
    import simulate
    truth = Truth(seed)
    sim = bodies.extend(simulate)
    nodes, tets, surface, coarse, wrenches = truth.run(simulate, sim, STEP)
    fine = truth.run(simulate, sim, 0.5 * STEP)[3]
    moved = (4 * fine - coarse) / 3
    scale = TRAVEL * float(max(truth.high - truth.low)) / np.linalg.norm(moved, axis=2).max()
    return truth, nodes, tets, surface, nodes[surface] + scale * moved, scale * wrenches
