"""A diagnosis of arrays: what it finds, and how it ends."""
import _thread
import json
import signal
import threading
import time
import unittest

import tissue_stiffness as ts
from bench import DAMPING, FALLEN, GRAVITY, INERTIA, Bench, arrays, elasticity, unknown


class DiagnosisTest(Bench):
    def hidden_damping(self):
        """Model file without the recording's damping, bag, and frames of arrays."""
        bag = self.simulate(INERTIA + GRAVITY + DAMPING + elasticity(4e5), FALLEN)
        model = self.write_model(INERTIA + GRAVITY + elasticity(unknown(8e5)))
        return model, bag, [ts.Frame(stamp, points, ids=ids) for stamp, points, ids in arrays(bag)[0]]

    def test_arrays_name_the_hidden_effect(self):
        model, bag, frames = self.hidden_damping()
        steps = []
        found = ts.diagnose(model, frames, progress=lambda *step: steps.append(step))
        self.assertEqual(found.verdict, 'missing')
        self.assertIn('viscous_damping', found.set)
        self.assertGreater(found.probabilities['viscous_damping'], 0.05)
        self.assertLessEqual(sum(found.probabilities.values()) + found.adequate + found.none_of_these, 1 + 1e-9)
        self.assertGreater(found.z, 3)
        self.assertTrue(found.complete)
        self.assertTrue(any('fit' in step[0] for step in steps), steps)
        self.tool('diagnose', model, bag, '--output', self.folder)
        tools = ts.read_diagnosis(self.path('diagnosis.json'))
        for key in set(found.content) - {'seconds'}:
            self.assertEqual(found.content[key], tools.content[key], key)
        self.assertEqual((found.set, found.probabilities, found.z), (tools.set, tools.probabilities, tools.z))
        self.assertEqual(found.model_next.replace(self.path('bar.vtk'), 'bar.vtk'), tools.model_next)

    def test_the_next_model_has_the_effect(self):
        model, _, frames = self.hidden_damping()
        found = ts.diagnose(model, frames, add=['viscous_damping'])
        self.assertEqual(found.final_effects, ['viscous_damping'])
        extended = ts.Model.from_text(found.model_next, self.folder)
        self.assertEqual(extended.effects, ts.Model(model).effects + ['viscous_damping'])
        self.assertLess(abs(found.parameters['elasticity.young_modulus'].mean / 4e5 - 1), 0.05)
        before, after = ts.estimate(model, frames), ts.estimate(extended, frames)
        self.assertLess(after.rms_error, before.rms_error / 2)
        self.assertLess(abs(after.young_modulus / 4e5 - 1), 0.05)

    def test_a_time_limit_gives_what_is_known_by_then(self):
        model, _, frames = self.hidden_damping()
        found = ts.diagnose(model, frames, time_limit=1e-6)
        self.assertEqual((found.complete, found.verdict), (False, 'unfinished'))
        self.refuses(lambda: ts.diagnose(model, frames, time_limit=0), 'time_limit: found 0')

    def test_an_interruption_ends_it_and_harms_nothing(self):
        signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell's background job lacks
        model, _, frames = self.hidden_damping()
        model, begun, ticks = ts.Model(model), threading.Event(), []

        def count_and_interrupt():
            begun.wait()
            while len(ticks) < 10:  # which takes as long as the search does where it holds up other threads
                ticks.append(time.monotonic())
                time.sleep(0.001)
            _thread.interrupt_main()
        thread = threading.Thread(target=count_and_interrupt)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            ts.diagnose(model, frames, progress=lambda *step: begun.set())
            self.fail('other threads did not run meanwhile')
        thread.join()

        def fail(*step):
            raise LookupError('the caller has no place for it')
        with self.assertRaisesRegex(LookupError, 'no place'):
            ts.diagnose(model, frames, progress=fail)
        self.assertTrue(ts.estimate(model, frames).frames[-1].used)

    def test_wrong_input_is_named(self):
        model, _, frames = self.hidden_damping()
        self.refuses(lambda: ts.diagnose(model, []), 'no usable frame')
        self.refuses(lambda: ts.diagnose(model, frames[::-1]), 'a frame at', 'frames in order of time')
        self.refuses(lambda: ts.diagnose(model, frames[:5]), 'frames')
        self.refuses(lambda: ts.diagnose(model, frames, add=['magic']), 'magic')
        self.refuses(lambda: ts.diagnose(model, [ts.Frame(0, [[0, 0]])]), 'shape (1, 2)')
        self.refuses(lambda: ts.read_diagnosis(self.write('a.json', json.dumps({'verdict': 'missing'}))), 'a.json')


if __name__ == '__main__':
    unittest.main()
