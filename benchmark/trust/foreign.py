"""Truths of other code: the shared cases, and new scenes of the independent simulator beside them. `python3 foreign.py
SIMULATOR NAME FOLDER` makes one of the new ones."""
import copy
import os
import sys

import numpy as np
import yaml

DENSITY = 1060.0
START = 1000.0  # s, first stamp
LOAD_RATE = 200.0
NOISE = 3e-4
PATCH = {'center': [0.0, 0.0, 0.06], 'radius': 0.02}

# Linear bodies, so that a linear model is right about all that is not hidden.
SCENES = {
    'cube_chirp': {'body': {'type': 'cube', 'h': 0.012, 'h_obs': 0.013}, 'material': {'E': 16000.0, 'nu': 0.45},
                   'patch': dict(PATCH, direction=[0.5, 0.2, -0.8], course={'type': 'chirp', 'amp': 900, 'f0': 0.8, 'f1': 5, 'T': 1.5}),
                   'time': {'fps': 60, 'frames': 90, 'substeps': 8}},
    'cube_hold': {'body': {'type': 'cube', 'h': 0.012, 'h_obs': 0.013}, 'material': {'E': 35000.0, 'nu': 0.45},
                  'patch': dict(PATCH, direction=[-0.3, 0.6, -0.7], course={'type': 'sum', 'terms': [
                      {'type': 'ramp', 't0': 0.1, 't1': 0.4, 'v0': 0, 'v1': 1500}, {'type': 'sine', 'amp': 600, 'freq': 2.2, 'soft': 0.3}]}),
                  'time': {'fps': 60, 'frames': 90, 'substeps': 8}},
    'ventricle_slow': {'body': {'type': 'lv', 'h': 0.0105, 'h_obs': 0.0115}, 'material': {'E': 22000.0, 'nu': 0.45},
                       'pressure': {'type': 'raised', 'amp': 1800, 'freq': 1.0},
                       'time': {'fps': 50, 'frames': 80, 'substeps': 6}},
    'ventricle_beats': {'body': {'type': 'lv', 'h': 0.0105, 'h_obs': 0.0115}, 'material': {'E': 45000.0, 'nu': 0.45},
                        'pressure': {'type': 'cardiac', 'amp': 3500, 'period': 0.7, 't0': 0.1},
                        'time': {'fps': 50, 'frames': 80, 'substeps': 6}},
    'bar_stiff': {'body': {'type': 'bar', 'h': 0.009, 'h_obs': 0.011}, 'material': {'E': 400000.0, 'nu': 0.45},
                  'gravity': {'g': 9.81, 'direction': [0.1, 0.5, -0.86]},
                  'time': {'fps': 60, 'frames': 75, 'substeps': 16}},
    'cube_sls': {'body': {'type': 'cube', 'h': 0.012, 'h_obs': 0.013}, 'material': {'E': 25000.0, 'nu': 0.45},
                 'viscoelastic': {'gamma': 0.5, 'tau': 0.15},
                 'patch': dict(PATCH, direction=[0.2, -0.5, -0.8], course={'type': 'chirp', 'amp': 1100, 'f0': 0.6, 'f1': 4, 'T': 1.5}),
                 'time': {'fps': 60, 'frames': 90, 'substeps': 8}},
    'cube_soft_support': {'body': {'type': 'cube', 'h': 0.012, 'h_obs': 0.013}, 'material': {'E': 20000.0, 'nu': 0.45},
                          'boundary': {'type': 'spring', 'k': 1.5e6},
                          'patch': dict(PATCH, direction=[0.4, 0.4, -0.8], course={'type': 'chirp', 'amp': 800, 'f0': 0.6, 'f1': 4, 'T': 1.5}),
                          'time': {'fps': 60, 'frames': 90, 'substeps': 8}},
    'ventricle_finite': {'body': {'type': 'lv', 'h': 0.0105, 'h_obs': 0.0115}, 'material': {'model': 'neo_hookean', 'E': 18000.0, 'nu': 0.45},
                         'pressure': {'type': 'raised', 'amp': 1300, 'freq': 1.2},
                         'time': {'fps': 50, 'frames': 80, 'substeps': 6}},
}
CLEAN = ['cube_chirp', 'cube_hold', 'ventricle_slow', 'ventricle_beats', 'bar_stiff']
HIDDEN = ['cube_sls', 'cube_soft_support', 'ventricle_finite']
CLAMPS = {'cube': {'box': {'min': [-1, -1, -1e-6], 'max': [1, 1, 1e-6]}},
          'lv': {'box': {'min': [-1, -1, 0.019999], 'max': [1, 1, 1]}},
          'bar': {'box': {'min': [-1e-6, -1, -1], 'max': [1e-6, 1, 1]}}}
# What the shared cases hide, as a model file says it: with it, the model is right.
TOLD = {
    'case_01': [], 'case_06': [],
    'case_02': [{'viscous_damping': {'beta': 0.006}}],
    'case_04': [{'viscoelasticity': {'gamma': 0.6, 'tau': 0.08}}],
    'case_10': [{'viscous_damping': {'beta': 0.012}}],
    'case_11': [{'gravity': {'acceleration': [0.0, 2.8189, -9.3964]}}],
    'case_12': [{'image_scale': {'ratio': 1.06}}],
}


def make(simulator, name, folder):
    """Simulates a scene and writes model.yaml, mesh.vtk, recording.bag without noise, and truth.yaml."""
    sys.path.insert(0, simulator)
    import rosbag
    from geometry_msgs.msg import WrenchStamped
    from sensor_msgs.msg import FluidPressure, PointField
    import genpy
    import sensor_msgs.point_cloud2 as point_cloud2
    import simulate
    scene = SCENES[name]
    config = copy.deepcopy(simulate.DEFAULTS)
    simulate.deep_update(config, {'name': name, 'material': {'model': 'linear', 'rho': DENSITY}})
    simulate.deep_update(config, scene)
    simulate.run(config, folder, verbose=False)
    given = os.path.join(folder, 'given')
    observed = np.load(os.path.join(given, 'observations.npz'))
    clean = np.load(os.path.join(folder, 'truth', 'clean.npz'))['surface_positions']
    with open(os.path.join(given, 'loads.yaml')) as file:
        loads = yaml.safe_load(file)
    body, modulus = scene['body']['type'], scene['material']['E']
    regions = {'clamp': CLAMPS[body]}
    effects = [{'inertia': {'density': DENSITY}},
               {'elasticity': {'law': 'linear', 'young_modulus': {'prior': modulus, 'factor': 3.0}, 'poisson_ratio': 0.45}},
               {'fixed': {'region': 'clamp'}}]
    stamp = lambda t: genpy.Time.from_sec(START + t)  # noqa: E731
    end = observed['time'][-1]
    times = np.arange(0.0, end + 1e-9, 1.0 / LOAD_RATE)
    fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate('xyz')]
    fields.append(PointField('vertex', 12, PointField.UINT32, 1))
    with rosbag.Bag(os.path.join(folder, 'recording.bag'), 'w') as bag:
        for k, (t, points) in enumerate(zip(observed['time'], clean)):
            header = simulate_header(k, stamp(t))
            rows = [(*map(float, p), int(vertex)) for p, vertex in zip(points, observed['mesh_node_id'])]
            bag.write('/tissue/vertices', point_cloud2.create_cloud(header, fields, rows), header.stamp)
        if 'patch' in scene:
            regions['patch'] = {'sphere': dict(PATCH)}
            effects.append({'traction': {'region': 'patch', 'topic': '/tool/wrench'}})
            area = loads['patch_traction']['effective_area']
            along = np.array(scene['patch']['direction']) / np.linalg.norm(scene['patch']['direction'])
            course = simulate.course(scene['patch']['course'])
            for k, t in enumerate(times):
                message = WrenchStamped(header=simulate_header(k, stamp(t)))
                message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = area * course(t) * along
                bag.write('/tool/wrench', message, message.header.stamp)
        if 'pressure' in scene:
            regions['cavity'] = {'ellipsoid': {'center': [0, 0, 0], 'radii': [0.0203, 0.0203, 0.0503]}}
            effects.append({'pressure': {'region': 'cavity', 'topic': '/tissue/pressure'}})
            course = simulate.course(scene['pressure'])
            for k, t in enumerate(times):
                message = FluidPressure(header=simulate_header(k, stamp(t)), fluid_pressure=course(t))
                bag.write('/tissue/pressure', message, message.header.stamp)
    if 'gravity' in scene:
        effects.append({'gravity': {'acceleration': [float(v) for v in loads['gravity']]}})
    os.replace(os.path.join(given, 'mesh.vtk'), os.path.join(folder, 'mesh.vtk'))
    model = {'mesh': {'file': 'mesh.vtk'}, 'regions': regions, 'effects': effects,
             'observations': [{'vertices': {'topic': '/tissue/vertices', 'noise': NOISE}}]}
    for name, content in (('model.yaml', model), ('truth.yaml', {'young_modulus': modulus})):
        with open(os.path.join(folder, name), 'w') as file:
            yaml.safe_dump(content, file, default_flow_style=None, sort_keys=False)


def simulate_header(number, stamp):
    from std_msgs.msg import Header
    return Header(seq=number, stamp=stamp, frame_id='model')


if __name__ == '__main__':
    make(*sys.argv[1:])
