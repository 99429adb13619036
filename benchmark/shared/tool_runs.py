"""Runs of the package's tools, for scores and studies."""
import subprocess

ANSWERED = (0, 3)  # 3: answered, but not to be used


class Failed(Exception):
    """A tool gave no answer; the text says why."""


def call(command, time_limit=None):
    """Runs a tool and returns what it printed. Raises Failed where it gives no answer, or none within the limit [s]."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=time_limit)
    except subprocess.TimeoutExpired:
        raise Failed('not done after %d s' % time_limit) from None
    if done.returncode not in ANSWERED:
        raise Failed('exit code %d: %s' % (done.returncode, (done.stderr.strip().splitlines() or [''])[-1]))
    return done.stdout
