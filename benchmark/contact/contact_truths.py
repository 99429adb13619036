"""Truths of the independent simulator in which a rigid ball touches a block: an indentation rig. `draw(simulator, seed)`
returns what a laboratory would have recorded: the ball's place and the force on it."""
import copy
import logging
import sys

import numpy as np

import meshes
from smooth_course import smooth

DENSITY, POISSON = 1060.0, 0.45
SIZE = (0.05, 0.05, 0.025)                # m; the block stands on a table, and its upper side is touched
FPS, FRAMES, STEP = 25.0, 32, 0.01        # Hz, -, s
POSE_RATE, POSE_NOISE = 100.0, 2e-6       # Hz, m: of a linear stage
FORCE_NOISE = 0.01                        # of the largest force
COARSE, FINE, OWN = 0.008, 0.003, 0.006   # m, edges: of the truth far from and near the ball, and of the mesh that is given
FIRM = 1e5                                # stiffness of the truth's contact over the modulus [1/m]: the ball enters by micrometres
MODULUS = (8e3, 60e3)                     # Pa
DISSIPATION = 0.5                         # spectral radius of the truth's integrator: a stiff contact would ring


def touched_sim(simulate):
    """The simulator's class with the tool's force within each step, where the step balances it; stiff contacts ring at its
    ends."""
    class Touched(simulate.Sim):
        def step(self, dt, depth=0):
            before, begun = self.un.x.array.copy(), self.t
            super().step(dt, depth)
            if self.t - begun < 0.99 * dt:
                return  # the step was halved, and the halves have told their forces
            now = self.un.x.array.copy()
            self.u.x.array[:] = (1 - self.af) * now + self.af * before
            self.set_loads(self.t - self.af * dt)
            self.told = [(self.t - self.af * dt, np.array([self.fem.assemble_scalar(f) for f in self.contact_force]))] + self.told[:1]
            self.u.x.array[:] = now

        def reaction(self):
            """Extrapolated to the end of the last step."""
            if len(self.told) < 2:
                return np.zeros(3)
            (last, force), (earlier, before) = self.told
            return force + (self.t - last) / (last - earlier) * (force - before)
    return Touched


class Truth:
    def __init__(self, seed):
        self.rng = rng = np.random.default_rng([7, seed])
        self.modulus = float(np.exp(rng.uniform(*np.log(MODULUS))))
        self.radius = float(rng.uniform(0.006, 0.012))
        self.center = [float(x) for x in rng.uniform(-0.006, 0.006, 2)]
        self.depth = float(rng.uniform(0.15, 0.35) * self.radius)
        self.clear = 0.0005  # m above the block at the start
        self.damping = float(rng.uniform(0.005, 0.02))
        self.end = (FRAMES - 1) / FPS

    def height(self, t):
        """Of the ball's lowest point: down, half up, and deeper."""
        times, depths = np.array([0.05, 0.45, 0.7, 1.1, 1.3]) * self.end / 1.3, np.array([0, 1, 0.5, 1.2, 0.3]) * self.depth
        way = self.clear * (1.0 - np.clip(t / times[1], 0, 1))
        return SIZE[2] + way - smooth(times, depths)(t)

    def config(self, simulate):
        c = copy.deepcopy(simulate.DEFAULTS)
        simulate.deep_update(c, {
            'body': {'type': 'cube', 'L': SIZE[0], 'W': SIZE[1], 'H': SIZE[2], 'h': COARSE, 'h_obs': OWN},
            'material': {'model': 'linear', 'E': self.modulus, 'nu': POISSON, 'rho': DENSITY},
            'damping': {'kelvin_voigt': self.damping, 'mass': 0.0},
            'indenter': {'shape': 'sphere', 'radius': self.radius, 'center': self.center, 'z': 0.0, 'k': FIRM * self.modulus,
                         'smooth': 2e-6},
            'time': {'fps': FPS, 'frames': FRAMES, 'rho_inf': DISSIPATION, 'substeps': int(round(1 / FPS / STEP))}})
        return c

    def refine(self, simulate, fine):
        """Lets the simulator mesh the block finely where the ball is."""
        def mesh(config, h, order, inclusions=(), algo=1, name='m'):
            import gmsh
            gmsh.initialize()
            gmsh.option.setNumber('General.Terminal', 0)
            gmsh.model.add(name)
            gmsh.model.occ.addBox(-SIZE[0] / 2, -SIZE[1] / 2, 0, *SIZE)
            gmsh.model.occ.synchronize()
            gmsh.option.setNumber('Mesh.MeshSizeMax', h)
            for option in ('General.NumThreads', 'Mesh.MaxNumThreads1D', 'Mesh.MaxNumThreads2D', 'Mesh.MaxNumThreads3D'):
                gmsh.option.setNumber(option, 1)
            if name != 'obs':
                near = gmsh.model.mesh.field.add('Ball')
                values = {'VIn': fine, 'VOut': h, 'XCenter': self.center[0], 'YCenter': self.center[1], 'ZCenter': SIZE[2],
                          'Radius': 1.3 * np.sqrt(1.2 * self.radius * self.depth), 'Thickness': 0.02}
                for key, value in values.items():
                    gmsh.model.mesh.field.setNumber(near, key, value)
                gmsh.model.mesh.field.setAsBackgroundMesh(near)
                gmsh.option.setNumber('Mesh.MeshSizeExtendFromBoundary', 0)
            return meshes.fill(gmsh, order)
        simulate.gmsh_mesh = mesh

    def run(self, simulate, fine=FINE):
        self.refine(simulate, fine)
        c = self.config(simulate)
        nodes, tets = simulate.linear_mesh(c, OWN)
        body = touched_sim(simulate)(c, verbose=False)
        body.told = []
        body.cf['zi'] = self.height
        body.init_accel()
        forces = []
        for k in range(FRAMES):
            for _ in range(c['time']['substeps'] if k else 0):
                body.step(1.0 / FPS / c['time']['substeps'])
            body.t = k / FPS
            forces.append(body.reaction())
        return nodes, tets, np.array(forces)


def draw(simulator, seed, fine=FINE):
    sys.path.insert(0, simulator)
    logging.disable(logging.INFO)
    import simulate
    truth = Truth(seed)
    return (truth, *truth.run(simulate, fine))
