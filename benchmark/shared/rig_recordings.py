"""What a rig records on truths of the independent simulator: stamps, and the force on a tool."""
import genpy
import numpy as np
from geometry_msgs.msg import WrenchStamped

from foreign import START, simulate_header

FAR_PRIOR = (0.4, 0.6, 1.7, 2.5)  # prior median over truth


def stamp(t):
    return genpy.Time.from_sec(START + t)


def write_wrench(bag, wrenches, rate, share, rng):
    """Writes forces [N], and torques [N m] where a row has six numbers, at a rate [Hz]. Their noise is a share of the
    largest one of each. Returns the noise of each."""
    parts = np.asarray(wrenches).reshape(len(wrenches), -1, 3)
    noise = share * np.abs(parts).max(axis=(0, 2))
    for k, vectors in enumerate(parts):
        message = WrenchStamped(header=simulate_header(k, stamp(k / rate)))
        for part, vector, std in zip((message.wrench.force, message.wrench.torque), vectors, noise):
            part.x, part.y, part.z = vector + std * rng.standard_normal(3)
        bag.write('/tool/wrench', message, message.header.stamp)
    return [float(std) for std in noise]


def write_force(bag, forces, rate, share, rng):
    """Does so with forces alone. Returns their noise [N]."""
    return write_wrench(bag, forces, rate, share, rng)[0]
