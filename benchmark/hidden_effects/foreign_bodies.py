"""What the independent simulator does not know of itself: more bodies, and physics that no effect of the library is.
`extend(simulate)` replaces its functions from the outside."""
import copy

import numpy as np

import meshes

LOAD_SPREAD = 0.0001  # m, edge of a load's window
FAR = 4.0             # m, from an end face to the centre of the ball that covers it alone

# Each is held at the face where it starts; `low` and `high`: the box around it [m]. `h`: the
# longest edge of the truth; `h_obs`: that of the mesh that is given.
BODIES = {
    'bar': {'body': {'type': 'bar', 'h': 0.010, 'h_obs': 0.0115}, 'low': [0, -0.01, -0.01], 'high': [0.1, 0.01, 0.01]},
    'slab': {'body': {'type': 'bar', 'L': 0.08, 'W': 0.05, 'H': 0.02, 'h': 0.0115, 'h_obs': 0.0125},
             'low': [0, -0.025, -0.01], 'high': [0.08, 0.025, 0.01]},
    'plate': {'body': {'type': 'bar', 'L': 0.09, 'W': 0.06, 'H': 0.014, 'h': 0.0125, 'h_obs': 0.0115},
              'low': [0, -0.03, -0.007], 'high': [0.09, 0.03, 0.007]},
    'cube': {'body': {'type': 'cube', 'h': 0.015, 'h_obs': 0.014},
             'low': [-0.03, -0.03, 0], 'high': [0.03, 0.03, 0.06]},
    'lv': {'body': {'type': 'lv', 'h': 0.0125, 'h_obs': 0.0115},
           'low': [-0.03, -0.03, -0.06], 'high': [0.03, 0.03, 0.02]},
    'tube': {'body': {'type': 'tube', 'L': 0.08, 'Ri': 0.012, 'Ro': 0.021, 'h': 0.007, 'h_obs': 0.010},
             'low': [-0.021, -0.021, 0], 'high': [0.021, 0.021, 0.08]},
    'lobe': {'body': {'type': 'lobe', 'a': 0.035, 'b': 0.028, 'c': 0.05, 'h': 0.014, 'h_obs': 0.013},
             'low': [-0.035, -0.028, 0], 'high': [0.035, 0.028, 0.05]},
}
BIG, EDGE = 1.0, 1e-6
TOOL = 0.024  # m, from the lobe's tip to the edge of what is pushed there


def box(low, high):
    return {'box': {'min': [float(x) for x in low], 'max': [float(x) for x in high]}}


def held_axis(name):
    """The axis along which the body stands out of its clamp, and the clamp's place on it."""
    if name in ('bar', 'slab', 'plate'):
        return 0, 0.0
    return 2, 0.02 if name == 'lv' else 0.0


def clamp(name, reach=0.0, part=1.0):
    """The region that is held, drawn `reach` metres deep into the body, and over that part of its width."""
    axis, place = held_axis(name)
    low, high = [-BIG] * 3, [BIG] * 3
    if name == 'lv':
        low[axis] = place - EDGE - reach
    else:
        high[axis] = place + EDGE + reach
    first, last = BODIES[name]['low'][1], BODIES[name]['high'][1]
    if part < 1.0:
        high[1] = first + part * (last - first)
    return box(low, high)


def end_of(name):
    """Where a tool pushes: the model's region, and the ball in which the simulator does."""
    axis, _ = held_axis(name)
    high = BODIES[name]['high']
    if name == 'lobe':
        ball = {'center': [0.0, 0.0, high[2]], 'radius': TOOL}
        return {'sphere': dict(ball, radius=1.001 * TOOL)}, ball
    low = [-BIG] * 3
    low[axis] = high[axis] - EDGE
    center = [0.0, 0.0, 0.0]
    center[axis] = high[axis] + FAR
    corner = [high[i] for i in range(3) if i != axis]
    return box(low, [BIG] * 3), {'center': center, 'radius': float(np.hypot(FAR, np.hypot(*corner)) + LOAD_SPREAD)}


def cavity(name):
    if name == 'lv':
        return {'ellipsoid': {'center': [0, 0, 0], 'radii': [0.0203, 0.0203, 0.0503]}}
    inner = 1.01 * BODIES['tube']['body']['Ri']
    return box([-inner, -inner, -BIG], [inner, inner, BIG])


def side_of(name):
    """Half of the surface beside the clamp: a predicate over points."""
    axis, place = held_axis(name)
    high = BODIES[name]['high']
    if name in ('bar', 'slab', 'plate'):
        return lambda x: np.abs(x[:, 2] - high[2]) < EDGE
    if name == 'cube':
        return lambda x: np.abs(x[:, 1] - high[1]) < EDGE
    return lambda x: ((x[:, 1] > -EDGE) & (np.hypot(x[:, 0], x[:, 1]) > 0.4 * high[0]) &
                      (np.abs(x[:, axis] - place) > EDGE))


def gmsh_volume(occ, kind, d):
    if kind == 'tube':
        outer, inner = (occ.addCylinder(0, 0, 0, 0, 0, d['L'], d[r]) for r in ('Ro', 'Ri'))
        return occ.cut([(3, outer)], [(3, inner)])
    ball = occ.addSphere(0, 0, 0, 1.0)
    occ.dilate([(3, ball)], 0, 0, 0, d['a'], d['b'], d['c'])
    half, _ = occ.cut([(3, ball)], [(3, occ.addBox(-1, -1, -2, 2, 2, 2))])
    tip, _ = occ.intersect(occ.copy(half), [(3, occ.addSphere(0, 0, d['c'], TOOL))])
    return occ.fragment(half, tip)  # facets end at the edge of what is pushed


def own_mesh(kind, d, h, order, name):
    import gmsh
    gmsh.initialize()
    gmsh.option.setNumber('General.Terminal', 0)
    gmsh.model.add(name)
    gmsh_volume(gmsh.model.occ, kind, d)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber('Mesh.MeshSizeMax', h)
    gmsh.option.setNumber('Mesh.MeshSizeMin', 0.6 * h)
    gmsh.option.setNumber('Mesh.Algorithm', 5 if name == 'obs' else 6)
    gmsh.option.setNumber('General.NumThreads', 1)
    return meshes.fill(gmsh, order)


def own_markers(kind, d):
    out = {'fixed': lambda x: np.abs(x[:, 2]) < EDGE}
    if kind == 'tube':
        out['endo'] = lambda x: np.abs(np.hypot(x[:, 0], x[:, 1]) - d['Ri']) < 1e-4
    return out


def extend(simulate):
    """Teaches the simulator tube and lobe, and the class below."""
    theirs = {name: getattr(simulate, name) for name in ('body_dims', 'markers', 'gmsh_mesh')}

    def own(config):
        return config['body']['type'] in ('tube', 'lobe')

    def dims(config):
        body = config['body']
        return (body['type'], {k: float(v) for k, v in body.items() if k in ('L', 'Ri', 'Ro', 'a', 'b', 'c')})

    simulate.body_dims = lambda config: dims(config) if own(config) else theirs['body_dims'](config)
    simulate.markers = lambda config: own_markers(*dims(config)) if own(config) else theirs['markers'](config)

    def gmsh_mesh(config, h, order, inclusions=(), algo=1, name='m'):
        if own(config):
            return own_mesh(*dims(config), h, order, name)
        return theirs['gmsh_mesh'](config, h, order, inclusions, algo, name)
    simulate.gmsh_mesh = gmsh_mesh
    return extended_sim(simulate)


def extended_sim(simulate):
    """The simulator's class with springs, pushes, a shaken frame, a jump of E and a second relaxing branch. What is
    linear is assembled once instead of twice a step."""
    import dolfinx
    import scipy.sparse
    import ufl

    def numbers(matrix):
        return scipy.sparse.csr_matrix(matrix.getValuesCSR()[::-1], shape=matrix.size)

    class Extended(simulate.Sim):
        def __init__(self, config, extra):
            self.springs, self.pushes, self.branches, self.extra = [], [], [], extra
            self.stiffness, self.now, self.dt = None, 0.0, 0.0
            super().__init__(copy.deepcopy(config), False)
            if 'ground' in extra:
                self.springs.append([*self.spring_on(side_of(extra['name'])), lambda t: extra['ground']])
            if 'slip' in extra:
                until, firm = extra['slip']
                grip = self.spring_on(simulate.markers(config)['fixed'])
                self.springs.append([*grip, lambda t: firm if t < until else 0.0])
            for push in extra.get('pushes', []):
                self.pushes.append((self.push_vector(push), simulate.course(push['course'])))
            if self.lin:
                self.assemble_once()

        def assemble_once(self):
            """Stiffness, damping and unit loads of a linear body; its relaxing branch becomes gamma K (u - z),
            tau z' = u - z, where K is the stiffness against a change of shape."""
            self.caf.value = self.ccv.value = 0.0
            bare = self.both(self.Jf)
            if self.ve:
                self.e1.value, self.e2.value = 0.0, 1.0
                shape = self.both(self.Jf)
                for whole, rest in zip(shape, bare):
                    whole.axpy(-1.0, rest)
                self.branches = [[numbers(shape[0]), shape[1], gamma, tau, np.zeros(self.ndof)]
                                 for gamma, tau in [(self.gam, self.tau)] + self.extra.get('branches', [])]
                self.ve, self.e2.value = False, 0.0
            self.ccv.value = 1.0
            damped = self.both(self.Jf)[0]
            self.ccv.value = 0.0
            stiffness = numbers(bare[0])
            self.damping = numbers(damped) - stiffness
            self.unit_loads = [(name, i, self.load_vector(name, i)) for name, i in
                               [('p', None), ('pp', None), ('T', None), ('g', 0), ('g', 1), ('g', 2)]]
            self.stiffness = stiffness

        def load_vector(self, name, i):
            constants = [c for k, c in self.k.items() if k != 'zi']
            for c in constants:
                c.value = 0.0 * np.array(c.value)
            self.k[name].value = 1.0 if i is None else np.eye(3)[i]
            self.u.x.array[:] = self.un.x.array[:] = self.vpre.x.array[:] = 0.0
            return super()._rint()

        def surface_measure(self, inside):
            facets = dolfinx.mesh.locate_entities_boundary(self.mesh, 2, lambda x: inside(x.T))
            facets = np.sort(facets).astype(np.int32)
            tags = dolfinx.mesh.meshtags(self.mesh, 2, facets, np.ones(len(facets), np.int32))
            return ufl.Measure('ds', self.mesh, subdomain_data=tags, metadata={'quadrature_degree': 4})(1)

        def both(self, form):
            """The matrix, and the one without the rows and columns of what is clamped."""
            out = []
            for conditions in ({}, {'bcs': self.bcs, 'diagonal': 0.0}):
                matrix = self.fem.petsc.assemble_matrix(form, **conditions)
                matrix.assemble()
                out.append(matrix)
            return out

        def spring_on(self, inside):
            w, du = ufl.TestFunction(self.V), ufl.TrialFunction(self.V)
            whole, free = self.both(self.fem.form(ufl.inner(w, du) * self.surface_measure(inside)))
            return numbers(whole), free

        def push_vector(self, push):
            """A force of 1 N, spread over the surface within a ball."""
            x = ufl.SpatialCoordinate(self.mesh)
            r = ufl.sqrt(sum((x[i] - float(push['center'][i])) ** 2 for i in range(3)) + 1e-14)
            window = 1 / (1 + ufl.exp((r - float(push['radius'])) / 0.002 * 4))
            ds = ufl.Measure('ds', self.mesh, metadata={'quadrature_degree': 4})
            area = self.fem.assemble_scalar(self.fem.form(window * ds))
            along = np.array(push['direction']) / np.linalg.norm(push['direction']) / area
            form = self.fem.form(window * ufl.inner(ufl.as_vector(list(along)), ufl.TestFunction(self.V)) * ds)
            return self.fem.petsc.assemble_vector(form).array.copy()

        def midpoint(self, tau):
            """Factors of z1 = a z0 + b (u0 + u1)."""
            half = 0.5 * self.dt / tau
            return (1 - half) / (1 + half), half / (1 + half)

        def set_loads(self, t):
            super().set_loads(t)
            before, self.now = self.now, t
            shake = self.extra.get('shake')
            if shake:  # a body in a shaken frame feels the opposite acceleration
                omega = 2 * np.pi * shake['freq']
                size = 0.5 * shake['size'] * omega ** 2 * np.cos(omega * t)
                self.k['g'].value[:] -= size * np.array(shake['direction'])
            if any(k(before) != k(t) for _, _, k in self.springs):
                self.fac_key = None
            jump = self.extra.get('jump')
            if jump and before < jump['time'] <= t:
                self.sr.x.array[:] *= jump['ratio']
                self.fac_key = None
                self.stiffness = jump['ratio'] * self.stiffness

        def _rint(self):
            af, un, u = float(self.caf.value), self.un.x.array, self.u.x.array
            ua = af * un + (1 - af) * u
            if self.stiffness is None:
                r = super()._rint()
            else:
                r = self.stiffness @ ua + self.damping @ (self.vpre.x.array + float(self.ccv.value) * (u - un))
                for name, i, vector in self.unit_loads:
                    r += float(self.k[name].value if i is None else self.k[name].value[i]) * vector
            for matrix, _, k in self.springs:
                r += k(self.now) * (matrix @ ua)
            for vector, course in self.pushes:
                r -= course(self.now) * vector
            for matrix, _, gamma, tau, z in self.branches:
                a, b = self.midpoint(tau)
                r += gamma * (matrix @ (ua - af * z - (1 - af) * (a * z + b * (un + u))))
            return r

        def _factor(self, mass):
            self.A.zeroEntries()
            self.fem.petsc.assemble_matrix(self.A, self.Jf, bcs=self.bcs)
            self.A.assemble()
            subset = self.PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN
            if mass != 0:
                self.A.axpy(mass, self.Mb, structure=self.PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
            share = 1 - float(self.caf.value)
            for _, free, k in self.springs:
                self.A.axpy(share * k(self.now), free, structure=subset)
            for _, free, gamma, tau, _ in self.branches:
                self.A.axpy(gamma * share * (1 - self.midpoint(tau)[1]), free, structure=subset)
            self.ksp.setOperators(self.A)
            self.ksp.setUp()
            self.nfac += 1

        def step(self, dt, depth=0):
            self.dt, before = dt, self.un.x.array.copy()
            super().step(dt, depth)
            for branch in self.branches:
                a, b = self.midpoint(branch[3])
                branch[4] = a * branch[4] + b * (before + self.un.x.array)

    return Extended
