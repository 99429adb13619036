#!/usr/bin/env python3
"""What scripts/print_estimate says of the messages that arrive, without nodes."""
import importlib.machinery
import importlib.util
import os
import sys
import unittest

import rospy
from tissue_stiffness.msg import StiffnessEstimate

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, 'scripts'))
import live_run  # noqa: E402

loader = importlib.machinery.SourceFileLoader('print_estimate', os.path.join(ROOT, 'scripts', 'print_estimate'))
print_estimate = importlib.util.module_from_spec(importlib.util.spec_from_loader('print_estimate', loader))
loader.exec_module(print_estimate)


def estimate(stamp, state):
    message = StiffnessEstimate(state=state, names=['elasticity.young_modulus', 'viscoelasticity.gamma'], units=['Pa', '-'],
                                mean=[12e3, 1.5], lower95=[11e3, 1.4], upper95=[13e3, 1.6])
    message.header.stamp = rospy.Time.from_sec(stamp)
    return message


class PrintEstimateTest(unittest.TestCase):
    def state_after(self, *messages):
        printer = print_estimate.Printer()
        for message in messages:
            printer.on_estimate(estimate(*message))
        return printer.state, printer.frames

    def test_the_silence_after_a_recording_leaves_the_last_state(self):
        self.assertEqual(self.state_after((1, 'converged'), (2, 'model_invalid'), (2, 'stale')), ('model_invalid', 2))

    def test_a_frame_processed_again_has_its_new_state(self):
        self.assertEqual(self.state_after((1, 'model_invalid'), (1, 'stale'), (1, 'converged')), ('converged', 1))

    def test_a_frame_that_is_stale_itself_says_so(self):
        self.assertEqual(self.state_after((1, 'converged'), (2, 'stale')), ('stale', 2))

    def test_a_number_without_a_unit_has_none(self):
        self.assertEqual(print_estimate.shown(estimate(1, 'converged')),
                         'elasticity.young_modulus = 12000 Pa (95 %: 11000 to 13000), '
                         'viscoelasticity.gamma = 1.5 (95 %: 1.4 to 1.6)')

    def test_what_is_printed_is_read_again(self):
        found = live_run.parse(print_estimate.shown(estimate(1, 'converged')) + ' after 90 frames [converged]')
        self.assertEqual(found['viscoelasticity.gamma'], {'mean': 1.5, 'interval95': [1.4, 1.6], 'frames': 90})
        self.assertEqual(found['elasticity.young_modulus']['mean'], 12e3)


if __name__ == '__main__':
    unittest.main()
