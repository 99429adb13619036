"""The estimator in Python: it gives what the tool gives, and names what is wrong with its input."""
import json
import os
import shutil
import subprocess
import sys
import threading
import unittest

import numpy as np
import tissue_stiffness as ts
from bench import GRAVITY, INERTIA, MODEL, PULL, PULLED, ROOT, SEEN, Bench, arrays, elasticity, unknown

MODULUS = 'elasticity.young_modulus'
MOTION = 1e-3 * np.linspace(0, 1, 20)


def falling_frames(mesh):
    """The bar's vertices on their way down."""
    down = np.outer(mesh.nodes[:mesh.corner_count, 0] ** 2, [0, 0, -1])
    return [ts.Frame(i / 30, mesh.nodes[:mesh.corner_count] + 100 * motion * down) for i, motion in enumerate(MOTION)]


class EstimatorTest(Bench):
    def results(self, effects, truth, simulation=PULLED):
        """Model file, bag, and the tool's results."""
        bag = self.simulate(truth, simulation)
        model = self.write_model(effects)
        self.tool('estimate', model, bag, '--output', self.folder)
        with open(self.path('results.json')) as file:
            return model, bag, json.load(file)

    def same(self, result, expected):
        self.assertEqual(set(result.parameters), set(expected['parameters']))
        for name, p in expected['parameters'].items():
            found = result.parameters[name]
            self.assertEqual([found.unit, found.mean, found.std, found.lower95, found.upper95],
                             [p['unit'], p['mean'], p['std'], *p['interval95']], name)
            self.assertEqual(result.identifiable[name].verdict, expected['identifiable'][name]['verdict'])
        self.assertEqual(result.state, expected['state'])
        for name in ('rms_error', 'noise_rms', 'relative_error'):
            self.assertAlmostEqual(getattr(result, name) / expected[name], 1, 9, name)

    def test_arrays_give_what_the_tool_gives(self):
        model, bag, expected = self.results(INERTIA + PULL + elasticity(unknown(2.4e4)), INERTIA + PULL + elasticity(1.2e4))
        frames, stamps, values = arrays(bag)
        self.assertEqual(len(frames), expected['frames'])
        result = ts.estimate(model, [ts.Frame(stamp, points, ids=ids) for stamp, points, ids in frames],
                             loads=ts.make_loads('/wrench', stamps, values))
        self.same(result, expected)
        self.assertLess(abs(result.young_modulus / 1.2e4 - 1), 0.05)
        self.assertEqual(result.interval, tuple(expected['parameters'][MODULUS]['interval95']))
        self.same(ts.estimate(ts.Model(model), bag), expected)

    def test_each_region_has_its_modulus(self):
        unknowns = elasticity(unknown(2e4), 'near') + elasticity(unknown(2e4), 'far')
        model, bag, expected = self.results(INERTIA + PULL + unknowns,
                                            INERTIA + PULL + elasticity(1.2e4, 'near') + elasticity(3e4, 'far'))
        frames, stamps, values = arrays(bag)
        estimator = ts.Estimator(model)
        for stamp, value in zip(stamps, values):
            estimator.add_load('/wrench', value, stamp)
        for stamp, points, ids in frames:
            step = estimator.step(ts.Frame(stamp, points, '/vertices', ids))
        self.assertTrue(step.used)
        for name, truth in ((MODULUS, 1.2e4), ('elasticity#2.young_modulus', 3e4)):
            self.assertEqual(step.estimate[name].mean, expected['parameters'][name]['mean'])
            self.assertTrue(step.estimate[name].lower95 < truth < step.estimate[name].upper95, step)
        self.refuses(lambda: step.young_modulus, 'young_modulus', 'several moduli', 'elasticity#2.young_modulus')
        self.refuses(lambda: step.estimate['elasticity'], 'parameter: found elasticity', MODULUS)

    def test_a_step_tells_more_than_the_estimate(self):
        estimator = ts.Estimator(self.write_model(INERTIA + GRAVITY + elasticity(unknown(4e5))))
        frames = falling_frames(estimator.mesh)
        for frame in frames:
            step = estimator.step(frame)
        count = estimator.mesh.corner_count
        self.assertEqual((step.young_modulus, step.state), (estimator.estimate.young_modulus, estimator.estimate.state))
        self.assertLess(step.interval[0], step.interval[1])
        self.assertEqual(step.estimate.covariance.shape, (1, 1))
        self.assertEqual(step.misfit.count, 3 * count)
        self.assertEqual(estimator.displacement.shape, estimator.mesh.nodes.shape)
        np.testing.assert_array_equal(estimator.prediction.measured, frames[-1].observations[0].points.ravel())
        self.assertEqual(len(estimator.free_run()), len(frames))
        self.assertFalse(estimator.step(frames[0]).used)
        self.assertIn('late', estimator.step(frames[0]).reason)
        estimator.reset()
        self.assertTrue(estimator.step(frames[0]).used)

    def test_limits_judge_later_frames_and_lose_no_estimate(self):
        model, bag, _ = self.results(INERTIA + PULL + elasticity(unknown(2.4e4)), INERTIA + PULL + elasticity(1.2e4))
        frames = ts.read_bag(model, bag).frames
        estimator = ts.Estimator(model)
        for frame in frames[:-2]:
            before = estimator.step(frame).estimate
        self.assertEqual(before.state, 'converged', before.state_reason)
        relative = before[MODULUS].std / before[MODULUS].mean
        estimator.set_state_limits(converged_within=0.5 * relative)
        self.assertEqual(estimator.estimate.state, 'converged')  # no frame has come since
        strict = estimator.step(frames[-2]).estimate
        self.assertEqual(strict.state, 'converging')
        self.assertIn('is known to', strict.state_reason)
        self.assertLess(abs(strict.young_modulus - before.young_modulus), before[MODULUS].std)
        estimator.set_state_limits()
        self.assertEqual(estimator.step(frames[-1]).state, 'converged')

    def test_a_limit_says_how_long_a_load_may_stay_away(self):
        text = MODEL + INERTIA + PULL + elasticity(unknown(2.4e4)) + SEEN

        def last_state(model, *limits, **named):
            estimator = ts.Estimator(ts.Model.from_text(model, self.folder))
            if limits or named:
                estimator.set_state_limits(*limits, **named)
            for frame in falling_frames(estimator.mesh):  # 0.63 s, with a load for the first half
                step = estimator.step(frame.load('/wrench', [0, 0, -1e-3]) if frame.stamp < 0.3 else frame)
            return step.state
        patient = last_state(text)
        self.assertNotEqual(patient, 'stale')
        self.assertEqual(last_state(text, 0.2, 0.2), 'stale')
        self.assertEqual(last_state(text, stale_after=0.5), patient)
        self.assertEqual(last_state(text + 'stale_after: 0.2\n'), 'stale')
        self.assertEqual(last_state(text + 'stale_after: 0.2\n', 0.1), 'stale')  # the model's own is kept

    def test_limits_that_cannot_be_are_refused(self):
        estimator = ts.Estimator(self.write_model(INERTIA + GRAVITY + elasticity(unknown(4e5))))
        for wrong in (0, -0.1, 0.21, np.nan, np.inf):
            self.refuses(lambda: estimator.set_state_limits(wrong), 'converged_within: found', 'at most 0.2')
        for wrong in (0, -1, np.nan):
            self.refuses(lambda: estimator.set_state_limits(stale_after=wrong), 'stale_after: found', 'more than 0 s')
        self.refuses(lambda: estimator.set_state_limits('tight'), "converged_within: found 'tight'", 'a number')
        estimator.set_state_limits(0.2, np.inf)

    def test_model_files_name_what_is_wrong(self):
        self.refuses(lambda: ts.Model(self.path('none.yaml')), 'none.yaml')
        self.refuses(lambda: ts.Model(self.write('model.yaml', MODEL + INERTIA + SEEN + 'colour: red\n')), 'model.yaml', 'colour')
        wrong = ts.Model(self.write_model(INERTIA + '- gravity: {direction: [0, 0, 1]}\n' + elasticity(unknown(4e5))))
        self.refuses(lambda: ts.Estimator(wrong), 'model.yaml:', 'direction')
        self.refuses(lambda: ts.Model.from_text('mesh: [', name='here'), 'here:1')
        self.refuses(lambda: ts.Estimator(self.write_model(INERTIA + elasticity(4e5))), 'effects', 'only known numbers')

    def test_a_model_reads_no_file_outside_its_folder_unless_allowed(self):
        os.mkdir(self.path('deep'))
        text = MODEL.replace('bar.vtk', '../bar.vtk') + INERTIA + elasticity(unknown(4e5)) + SEEN
        file = self.write(os.path.join('deep', 'model.yaml'), text)
        words = ('mesh.file: found ../bar.vtk', 'a file in the folder ', 'deep, or allow_outside=True')
        self.refuses(lambda: ts.Model(file), 'model.yaml', *words)
        self.refuses(lambda: ts.Estimator(file), *words)
        self.refuses(lambda: ts.Model.from_text(text, self.path('deep')), *words)
        course = ['traction: {region: end, course: {file: /etc/hostname, columns: [time, x, y, z]}}']
        inside = ts.Model(self.write_model(INERTIA + elasticity(unknown(4e5))))
        self.refuses(lambda: inside.with_effects(course), 'course.file: found /etc/hostname')
        for model in (ts.Model(file, allow_outside=True), ts.Model.from_text(text, self.path('deep'), allow_outside=True)):
            self.assertEqual(ts.build_mesh(model.with_effects([GRAVITY[2:]])).corner_count, 99)

    def test_meshes_of_other_programs_are_read(self):
        for name in ('box.vtu', 'box.inp'):
            shutil.copy(os.path.join(ROOT, 'test', 'data', 'meshing', name), self.path(name))
            text = MODEL.replace('bar.vtk', name) + INERTIA + elasticity(unknown(4e5)) + SEEN
            self.assertEqual(len(ts.build_mesh(ts.Model.from_text(text, self.path('.'))).tets), 12)

    def test_arrays_that_do_not_fit_are_named(self):
        estimator = ts.Estimator(self.write_model(INERTIA + PULL + elasticity(unknown(2.4e4))))
        points = estimator.mesh.nodes[:5]

        def step(*arguments, **more):
            return lambda: estimator.step(ts.Frame(0.5, *arguments, **more))
        self.refuses(step(points[:, :2], ids=range(5)), '/vertices at 0.5 s: points', 'shape (5, 2)', 'shape (n, 3) [m]')
        self.refuses(step(points.astype(str), ids=range(5)), '/vertices at 0.5 s: points', 'dtype')
        self.refuses(step(points.astype(complex), ids=range(5)), 'dtype complex128')
        self.refuses(step([[1, 2, 3], [4, 5]], ids=range(2)), '/vertices at 0.5 s: points')
        broken = points.copy()
        broken[3, 1] = np.nan
        self.refuses(step(broken, ids=range(5)), 'not finite in row 3', 'leave out')
        self.refuses(step(points), 'ids: found none for 5 points', 'all 99 points')
        self.refuses(step(points, ids=range(4)), 'ids: found 4 for 5 points')
        self.refuses(step(points, ids=[0, 1, 2, 3, 99]), 'ids: found 99 in row 4', '0 to 98')
        self.refuses(step(points, ids=[0, 1, 2, 3, -1]), 'ids: found -1 in row 4')
        self.refuses(step(points, ids=np.arange(5.0)), 'ids: found dtype float64', 'integers')
        self.refuses(step(points, topic='/points', ids=range(5)), 'topic: found /points', '/vertices')
        self.refuses(step(loads={'/force': [0, 0, 1]}), 'load: found /force', '/wrench')
        self.refuses(step(loads={'/wrench': [1, 2]}), '/wrench at 0.5 s: found 2 numbers', '(6,)')
        self.refuses(step(loads={'/wrench': [1, 2, np.inf]}), '/wrench at 0.5 s', 'not finite')
        self.refuses(lambda: estimator.step(ts.Frame('noon', points)), "stamp: found 'noon'")
        self.refuses(lambda: estimator.step(ts.Frame(np.nan, points)), 'stamp: found', 'finite')
        self.refuses(lambda: ts.make_frames([0, 1], [points]), 'points: found shape (1, 5, 3)', '2 rows')
        self.refuses(lambda: ts.estimate(estimator.model, []), 'no usable frame')

    def test_each_kind_of_sensor_and_load(self):
        effects = INERTIA + elasticity(unknown(2e4)) + ('- pressure: {region: near, topic: /pressure}\n'
                                                        '- moved: {region: end, topic: /pose}\n')
        sensors = ('observations:\n- markers: {topic: /markers, noise: 1e-4, rest: [[0.05, 0, 0], [0.05, 0.02, 0]]}\n'
                   '- points: {topic: /points, noise: 1e-4}\n- reaction: {topic: /reaction, region: end, noise: 0.01}\n')
        estimator = ts.Estimator(ts.Model.from_text(MODEL + effects + sensors, self.folder))
        self.assertEqual({load.topic: load.kind for load in estimator.load_inputs}, {'/pressure': 'pressure', '/pose': 'pose'})
        self.assertEqual([sensor.kind for sensor in estimator.model.observations], ['markers', 'points', 'reaction'])
        markers = np.array([[0.05, 0, 0.001], [0.05, 0.02, 0.001]])
        pose = np.array([[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]])

        def seen(**loads):
            loads = {'/' + name: load for name, load in loads.items()}
            return ts.Frame(0.5, markers, '/markers', loads=loads).observe(markers[:1], '/points').observe([1, 2, 3], '/reaction')
        frame, loads = seen(pressure=120.0, pose=pose).checked(estimator._inputs)
        self.assertEqual([(o.kind, o.ids.tolist(), o.count) for o in frame.observations],
                         [('markers', [0, 1], 2), ('points', [], 1), ('reaction', [], 0)])
        np.testing.assert_array_equal(frame.observations[0].points, markers)
        np.testing.assert_array_equal(frame.observations[2].points, [[1, 2, 3]])
        self.assertEqual([load.value.tolist() for load in loads], [[120], [0.1, 0.2, 0.3, 0, 1, 0, -1, 0, 0, 0, 0, 1]])
        later = ts.Frame(0.5).load('/pressure', 5, stamp=0.4).load('/pressure', 6).checked(estimator._inputs)[1]
        self.assertEqual([load.time for load in later], [0.4, 0.5])
        for wrong in (2 * pose, pose[[1, 0, 2, 3]], pose[:, [0, 1, 2, 2]]):
            self.refuses(lambda: estimator.step(seen(pose=wrong)), '/pose at 0.5 s: found a matrix that is no pose')
        self.refuses(lambda: estimator.step(seen(pose=[1, 2, 3])), '/pose at 0.5 s: found 3 numbers', '(4, 4)')
        self.refuses(lambda: estimator.step(seen(pressure=[1, 2])), '/pressure at 0.5 s: found 2 numbers', 'a pressure [Pa]')
        self.refuses(lambda: estimator.step(seen().observe([1, 2], '/reaction')), '/reaction at 0.5 s: points: found 2', 'force')
        self.refuses(lambda: estimator.step(ts.Frame(0.5, markers, '/points', [0, 1])), '/points at 0.5 s: ids', 'no identity')
        self.refuses(lambda: estimator.step(ts.Frame(0.5, markers, '/markers', [0, 2])), 'ids: found 2 in row 1', '0 to 1')
        self.refuses(lambda: estimator.step(ts.Frame(0.5, markers)), 'topic: found none', '/markers, /points, /reaction')

    def test_a_wrong_frame_changes_nothing(self):
        model = self.write_model(INERTIA + PULL + elasticity(unknown(2.4e4)))
        first, second = ts.Estimator(model), ts.Estimator(model)
        for frame in falling_frames(first.mesh):
            frame.load('/wrench', [0, 0, -1e-3])
            first.step(frame)
            self.refuses(lambda: second.step(ts.Frame(frame.stamp, [[0, 0, np.nan]], loads={'/wrench': [1, 1, 1]})), 'row 0')
            second.step(frame)
        self.assertEqual(first.estimate.young_modulus, second.estimate.young_modulus)
        self.assertEqual(first.estimate.covariance, second.estimate.covariance)

    def test_threads_share_an_estimator(self):
        estimator = ts.Estimator(self.write_model(INERTIA + GRAVITY + elasticity(unknown(4e5))))
        results = []

        def run(frames):
            results.extend(estimator.step(frame).used for frame in frames)
        frames = falling_frames(estimator.mesh)
        threads = [threading.Thread(target=run, args=[frames]) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual((len(results), len(estimator.free_run())), (3 * len(frames), sum(results)))

    def test_frames_of_another_model_are_refused(self):
        bag = self.simulate(INERTIA + PULL + elasticity(1.2e4), PULLED)
        frames = ts.read_bag(self.write_model(INERTIA + PULL + elasticity(unknown(2e4))), bag).frames
        other = MODEL + INERTIA + PULL + elasticity(unknown(2e4)) + SEEN.replace('vertices:', 'points:')
        self.refuses(lambda: ts.Estimator(self.write('other.yaml', other)).step(frames[0]), 'vertices of entry 0')

    def test_ros_is_not_needed(self):
        program = ('import sys, tissue_stiffness as ts\n'
                   'assert "tissue_stiffness._core" not in sys.modules\n'  # what is imported for the messages alone
                   'ts.Estimator, ts.diagnose, ts.read_results\n'
                   'loaded = open("/proc/self/maps").read()\n'
                   'print("_core" in loaded, "libros" in loaded, "rospy" in sys.modules, "genpy" in sys.modules)')
        found = subprocess.run([sys.executable, '-c', program], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
        self.assertEqual(found.split(), ['True', 'False', 'False', 'False'])


if __name__ == '__main__':
    unittest.main()
