"""What /diagnostics says of a running estimator, for tests that wait for it."""
import subprocess
import threading

import roslib.packages
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus


class EstimatorStatus:
    """A test derives from this one, and keeps the subscriber that `watch_status` returns. `changed` is notified of each message."""

    @classmethod
    def watch_status(cls):
        cls.changed = threading.Condition()
        cls.level, cls.message, cls.values, cls.heard = DiagnosticStatus.OK, '', {}, 0
        return rospy.Subscriber('/diagnostics', DiagnosticArray, cls.on_diagnostics)

    @classmethod
    def on_diagnostics(cls, message):
        with cls.changed:
            for status in message.status:
                if status.name.endswith('estimator'):
                    cls.level, cls.message = status.level, status.message
                    cls.values = {entry.key: entry.value for entry in status.values}
                    cls.heard += 1
            cls.changed.notify_all()

    @classmethod
    def wait_for_waiting_frames(cls, seconds):
        cls.wait_for_values({'frames waiting': '0'}, seconds)

    @classmethod
    def wait_for_reprocessing(cls, seconds):
        cls.wait_for_values({'frames waiting': '0', 'reprocessing': 'no'}, seconds)

    # The first two messages may have been made before the call.
    @classmethod
    def wait_for_values(cls, wanted, seconds):
        with cls.changed:
            heard = cls.heard
            if not cls.changed.wait_for(lambda: cls.heard >= heard + 3 and wanted.items() <= cls.values.items(), seconds):
                raise AssertionError('%s is not yet true: %s' % (wanted, cls.values))


class OwnEstimator(EstimatorStatus):
    """A test derives from this one to run an estimator_node of its own, `node`. It waits for at most `patience` seconds."""
    patience = 60

    @classmethod
    def run_node(cls, *options):
        program = roslib.packages.find_node('tissue_stiffness', 'estimator_node')[0]
        cls.node = subprocess.Popen([program, '_model:=' + rospy.get_param('~model'), '_diagnostic_period:=0.1'] + list(options))

    @classmethod
    def tearDownClass(cls):
        if cls.node.poll() is None:
            cls.node.kill()
            cls.node.wait()

    def wait_for(self, condition, text):
        with self.changed:
            self.assertTrue(self.changed.wait_for(condition, self.patience), '%s; diagnostics are %s' % (text, self.values))
