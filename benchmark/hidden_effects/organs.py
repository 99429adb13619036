"""Two more bodies of the study, a block worked by a tool and a ventricle filled by a pressure: unlike the slender scenes
they hardly ring, and what fibres, muscles, clamps and sensors do to them is hidden as well."""
import os

import numpy as np

from meshes import revolved, write_obj
from scenes import Scene, elasticity, faces, wrench

DENSITY = 1060.0
INNER, OUTER, BASE = (0.02, 0.05), (0.03, 0.06), 0.02  # m: radius and half length of the ventricle's walls; height of its base


def around(**more):
    return dict(direction='circumferential', axis=[0, 0, 1], center=[0, 0, 0], **more)


def arch(amplitude, onset, duration):
    return {'active_contraction': around(amplitude=amplitude, period=0.8, onset=onset, duration=duration, sharpness=2)}


class Block(Scene):
    """A cube, held at one face, pushed on the middle of the other."""

    rate, noise = 60.0, 3e-4
    own = ('stiff_inclusion', 'gravity')  # hidden otherwise than in other boxes

    def truth(self, modulus, hidden, s, load):
        regions, effects = super().truth(modulus, 'none' if hidden in self.own else hidden, s, load)
        middle = [0.5 * length for length in self.size]
        if hidden == 'stiff_inclusion':  # the elements of a ball
            regions['ball'] = {'sphere': {'center': [middle[0] + 0.006, middle[1] + 0.01, middle[2] - 0.006], 'radius': 0.013}}
            effects.append(elasticity(modulus * s, region='ball'))
        elif hidden == 'gravity':
            effects.append({'gravity': {'acceleration': [-9.4 * s, 2.8 * s, 0.0]}})
        return regions, effects


class Ventricle(Scene):
    """A thick half ellipsoid, held at its base."""

    rate, noise = 50.0, 3e-4
    own = ('fibre_reinforcement', 'active_contraction', 'stiff_inclusion', 'elastic_support', 'foundation', 'gravity')
    edge, true_edge = 0.0105, 0.0075

    def __init__(self, name, modulus, loads):
        region = {'clamp': {'box': {'min': [-1, -1, BASE - 1e-6], 'max': [1, 1, 1]}},
                  'cavity': {'ellipsoid': {'center': [0, 0, 0], 'radii': [INNER[0] + 3e-4, INNER[0] + 3e-4, INNER[1] + 3e-4]}},
                  'neighbour': {'box': {'min': [-1, -1, -1], 'max': [-0.014, 1, 1]}}}
        known = [{'inertia': {'density': DENSITY}}, {'fixed': {'region': 'clamp'}},
                 {'pressure': {'region': 'cavity', 'topic': '/tissue/pressure'}}]
        super().__init__(name, [0.06, 0.06, 0.08], None, None, modulus, region, known, loads)

    def surface(self, edge):
        """Outer wall from the apex, base, inner wall to the apex."""
        def wall(radius, length):
            angles = np.linspace(0.0, np.arccos(-BASE / length), int(round(1.7 * length / edge)) + 1)
            return [(radius * np.sin(a), -length * np.cos(a)) for a in angles]
        outer, inner = wall(*OUTER), wall(*INNER)
        rim = np.linspace(outer[-1], inner[-1], max(2, int(round((OUTER[0] - INNER[0]) / edge)) + 1))[1:-1]
        line = np.concatenate([outer, rim, inner[::-1]])
        return revolved(line, int(round(2 * np.pi * OUTER[0] / edge)))

    def write_mesh(self, folder, name, true, hidden='none'):
        edge = self.true_edge if true else self.edge
        write_obj(os.path.join(folder, name + '.obj'), *self.surface(edge))
        return {'file': name + '.obj', 'max_edge_length': edge}

    def markers(self):
        """Every second corner of the model's surface."""
        return [[float(x) for x in point] for point in self.surface(self.edge)[0][::2]]

    def truth(self, modulus, hidden, s, load):
        regions, effects = super().truth(modulus, 'none' if hidden in self.own else hidden, s, load)
        if hidden == 'fibre_reinforcement':  # two families that cross where the library has one
            effects += [{'fibre_reinforcement': around(angle=angle, modulus=0.5 * s * modulus)} for angle in (-0.3, 0.3)]
        elif hidden == 'active_contraction':  # quick to rise, slow to fall; the library's arch is as quick as slow
            effects += [arch(0.05 * s * modulus, 0.1, 0.3), arch(0.03 * s * modulus, 0.2, 0.4)]
        elif hidden == 'stiff_inclusion':  # a part of the wall
            regions['scar'] = {'box': {'min': [0.01, -0.015, -0.03], 'max': [1, 0.015, -0.005]}}
            effects.append(elasticity(modulus * s, region='scar'))
        elif hidden == 'elastic_support':
            effects.append({'elastic_support': {'region': 'clamp', 'compliance': 2e-3 * s / modulus}})
        elif hidden == 'foundation':
            effects.append({'foundation': {'region': 'neighbour', 'stiffness': 3.0 * s * modulus}})
        elif hidden == 'gravity':
            effects.append({'gravity': {'acceleration': [0.0, 4.0 * s, -9.0 * s]}})
        return regions, effects


def organs():
    size = [0.06, 0.06, 0.06]
    regions = faces(size)
    regions['patch'] = {'box': {'min': [size[0] - 1e-6, 0.02 - 1e-6, 0.02 - 1e-6], 'max': [1, 0.04 + 1e-6, 0.04 + 1e-6]}}
    known = [{'inertia': {'density': DENSITY}}, {'fixed': {'region': 'clamp'}},
             {'traction': {'region': 'patch', 'topic': '/tool/wrench'}}]
    return [Block('block worked by a tool', size, [6, 6, 6], [9, 9, 9], 20e3, regions, known,
                  wrench({'direction': [-0.85, 0.4, 0.2], 'sine': {'amplitude': 1.5, 'frequency': 1.3}},
                         {'direction': [-0.85, 0.4, 0.2], 'sine': {'amplitude': 0.8, 'frequency': 2.9}})),
            Ventricle('ventricle filled by a pressure', 28e3,
                      {'/tissue/pressure': {'rate': 200, 'terms': [{'raised_cosine': {'amplitude': 2700, 'frequency': 1.25}},
                                                                   {'raised_cosine': {'amplitude': 700, 'frequency': 2.5}}]}})]
