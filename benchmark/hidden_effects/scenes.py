"""Scenes of the study, and what is hidden in them. A truth never is the estimator's own model: it runs on a finer mesh with
other nodes, in time steps instead of modes, and most hidden effects take another form than the library's."""

import os

from meshes import box, write_vtk

STEP = 0.0005       # s, of a truth
TRIAL_STEP = 0.001  # s, where only an effect's size is asked for
LONG_STEP = 0.01    # s, of one that is said to have been simulated in long steps
RATE = 30.0         # frames/s
NOISE = 2e-4        # m
LAYER_CELLS = 2
PUSH_TOPIC = '/unknown/wrench'
PUSH_DIRECTION = [0.0, 0.6, 0.8]


def elasticity(modulus, poisson=0.45, **more):
    return {'elasticity': dict(law='linear', young_modulus=modulus, poisson_ratio=poisson, **more)}


def faces(size):
    return {'clamp': {'box': {'min': [-1, -1, -1], 'max': [1e-6, 1, 1]}},
            'tip': {'box': {'min': [size[0] - 1e-6, -1, -1], 'max': [1, 1, 1]}},
            'side': {'box': {'min': [-1, -1, -1], 'max': [1, 1, 1e-6]}}}


def wrench(*terms):
    return {'/tool/wrench': {'rate': 200, 'terms': list(terms)}}


def step_of(hidden, strength, usual):
    """Time step of a truth [s]: long ones are what elongates periods."""
    return min(1.0 / RATE, max(usual, LONG_STEP * strength)) if hidden == 'period_elongation' else usual


class Scene:
    """A box, its loads, and how each effect is hidden in it at strength s (1: about as large as tissue has it)."""

    rate, noise = RATE, NOISE

    def __init__(self, name, size, cells, true_cells, modulus, regions, effects, loads):
        self.name, self.size, self.cells, self.true_cells, self.modulus = name, size, cells, true_cells, modulus
        self.regions, self.effects, self.loads = regions, effects, loads

    def markers(self):
        """Every second of the nodes on the model's surface."""
        surface = [list(node) for node in self.nodes_and_tets(self.cells)[0]
                   if any(min(x, length - x) < 1e-9 for x, length in zip(node, self.size))]
        return surface[::2]

    def effects_under(self, load):
        """The known effects, the gravity `load` times as strong."""
        scaled = {'gravity': lambda v: {'acceleration': [load * a for a in v['acceleration']]}}
        return [{name: scaled.get(name, lambda v: v)(value) for name, value in effect.items()} for effect in self.effects]

    def loads_with(self, modulus, hidden, s):
        """What acts, and an unknown push that bends the body like a cantilever by about 2 mm where s is 1."""
        if hidden != 'push':
            return self.loads
        force = 1e-3 * s * modulus * self.size[1] * self.size[2] ** 3 / self.size[0] ** 3
        lean = [{'direction': PUSH_DIRECTION, 'ramp': {'to': to, 'start': start, 'end': start + 0.1}}
                for to, start in ((force, 0.4), (-force, 0.9))]
        return dict(self.loads, **{PUSH_TOPIC: {'rate': 200, 'terms': lean}})

    def layer(self, hidden):
        """Thickness of what lies between the body and what holds it [m]."""
        return 0.05 * self.size[0] if hidden == 'elastic_support' else 0.0

    def write_mesh(self, folder, name, true, hidden='none'):
        """The model's mesh, or the one of the truth; what a model file says of it."""
        write_vtk(os.path.join(folder, name + '.vtk'), *self.nodes_and_tets(self.true_cells if true else self.cells, hidden))
        return {'file': name + '.vtk'}

    def nodes_and_tets(self, cells, hidden='none'):
        """Of the body and of the layer that it may be held by."""
        layer = self.layer(hidden)
        more = LAYER_CELLS if layer else 0
        nodes, tets = box([cells[0] + more] + self.size[1:], [cells[0] + more] + cells[1:])

        def place(i):
            return layer * (i / more - 1) if i < more else self.size[0] * (i - more) / cells[0]
        return [(place(round(node[0])), *node[1:]) for node in nodes], tets

    def truth(self, modulus, hidden, s, load):
        """Regions and effects of the body with `hidden` in it."""
        regions, effects = dict(self.regions), [elasticity(modulus)] + self.effects_under(load)
        length = self.size[0]
        big = 1.0
        if hidden == 'viscous_damping':
            effects.append({'viscous_damping': {'beta': 5e-3 * s}})
        elif hidden == 'mass_damping':
            effects.append({'mass_damping': {'alpha': 1.5 * s}})
        elif hidden == 'viscoelasticity':  # two branches where the library has one
            effects += [{'viscoelasticity': {'gamma': 0.25 * s, 'tau': 0.05}}, {'viscoelasticity': {'gamma': 0.15 * s, 'tau': 0.15}}]
        elif hidden == 'elastic_support':  # a soft layer beneath the body where the library has springs
            regions['clamp'] = {'box': {'min': [-big] * 3, 'max': [1e-6 - self.layer(hidden), big, big]}}
            regions['layer'] = {'box': {'min': [-big] * 3, 'max': [1e-6, big, big]}}
            regions['rest'] = {'box': {'min': [-1e-6, -big, -big], 'max': [big] * 3}}
            effects[:1] = [elasticity(modulus / s, region='layer'), elasticity(modulus, region='rest')]
        elif hidden == 'stiff_inclusion':  # a block of elements where the library has a smooth ball
            low, high = 0.25 * length, 0.5 * length
            regions['block'] = {'box': {'min': [low, -big, -big], 'max': [high, 0.5 * self.size[1], big]}}
            effects.append(elasticity(modulus * s, region='block'))  # on top of the whole body's
        elif hidden == 'added_mass':
            effects.append({'added_mass': {'region': 'tip', 'mass': 0.1 * s * 1000 * self.size[0] * self.size[1] * self.size[2]}})
        elif hidden == 'foundation':
            effects.append({'foundation': {'region': 'side', 'stiffness': 0.3 * s * modulus / length}})
        elif hidden == 'compressibility':  # another Poisson's ratio from the start
            effects[0] = elasticity(modulus, poisson=0.45 - 0.1 * min(s, 4.0))
        elif hidden == 'gravity':
            effects.append({'gravity': {'acceleration': [0.0, 0.7 * s, 0.7 * s]}})
        elif hidden == 'image_scale':
            effects.append({'image_scale': {'ratio': 1.0 + 0.2 * s}})
        elif hidden == 'time_offset':
            effects.append({'time_offset': {'offset': 0.01 * s}})
        elif hidden == 'push':  # somebody leans on the body for a while: no effect of the library
            effects.append({'traction': {'region': 'side', 'topic': PUSH_TOPIC}})
        elif hidden == 'geometric_nonlinearity':  # a hyperelastic law, under s times the load
            effects[0] = {'elasticity': {'law': 'neo_hookean', 'young_modulus': modulus, 'poisson_ratio': 0.45}}
        elif hidden not in ('none', 'period_elongation'):  # the second: the same body in longer steps
            raise ValueError(hidden)
        return regions, effects


def scenes():
    bar, slab = [0.10, 0.02, 0.02], [0.08, 0.05, 0.02]
    base = [{'inertia': {'density': 1000.0}}, {'fixed': {'region': 'clamp'}}]
    pulled = base + [{'traction': {'region': 'tip', 'topic': '/tool/wrench'}}]
    return [
        Scene('bar released under gravity', bar, [20, 2, 2], [25, 5, 5], 60e3, faces(bar),
              base + [{'gravity': {'acceleration': [0.0, 1.5, -4.0]}}], {}),
        Scene('bar pushed and let go', bar, [20, 2, 2], [25, 5, 5], 40e3, faces(bar), pulled,
              wrench({'direction': [0, 0, -1], 'ramp': {'to': 0.02, 'start': 0.1, 'end': 0.15}},
                     {'direction': [0, 1, 0], 'sine': {'amplitude': 0.01, 'frequency': 2.3}})),
        Scene('slab worked by a tool', slab, [10, 5, 2], [15, 9, 5], 15e3, faces(slab), pulled,
              wrench({'direction': [0, 0, -1], 'raised_cosine': {'amplitude': 0.05, 'frequency': 1.0}},
                     {'direction': [1, 0, 0], 'sine': {'amplitude': 0.3, 'frequency': 1.6}})),
    ]
