"""What is measured: frames and loads of arrays, or of a rosbag."""
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Iterable, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _core
from .errors import input_error

if TYPE_CHECKING:
    PathLike = Union[str, 'os.PathLike[str]']


class Load(NamedTuple):
    """One measured value of a load: a pressure [Pa], a force (3,) [N] with or without its torque (6,) [N m], or a pose (4, 4)."""
    topic: str
    stamp: float  # [s]
    value: Any


class Sighting(NamedTuple):
    """What one sensor saw, before it is checked against a model."""
    topic: Optional[str]
    points: Any
    ids: Any


class Frame:
    """Everything that was measured at one instant.

    stamp: time of the measurement [s].
    points: positions (n, 3) in the model's frame [m]; of a reaction its force (3,) [N].
    topic: which entry of the model's `observations`; it may be left out where there is one.
    ids: (n,) vertex of the mesh, or index of the marker, of each point; it may be left out where all are there in order.
    loads: measured loads at this stamp by topic, as in Load.
    """

    def __init__(self, stamp: float, points: Any = None, topic: Optional[str] = None, ids: Any = None,
                 loads: Optional[Mapping[str, Any]] = None):
        self.stamp = stamp
        self.observations: List[Union[Sighting, _core.Observation]] = []
        self.loads: List[Union[Load, _core.LoadSample]] = []
        self.reason = ''  # why a recording's frame holds no observation
        if points is not None:
            self.observe(points, topic, ids)
        for name, value in (loads or {}).items():
            self.load(name, value)

    def observe(self, points: Any, topic: Optional[str] = None, ids: Any = None) -> 'Frame':
        """Adds what a further sensor saw at this instant."""
        self.observations.append(Sighting(topic, points, ids))
        return self

    def load(self, topic: str, value: Any, stamp: Optional[float] = None) -> 'Frame':
        """Adds a load, measured at the frame's stamp or at another one [s]."""
        self.loads.append(Load(topic, self.stamp if stamp is None else stamp, value))
        return self

    def checked(self, inputs: _core.Inputs) -> Tuple[_core.Frame, List[_core.LoadSample]]:
        """The frame and its loads as the library takes them. Raises InputError for what does not fit the model."""
        stamp = number(self.stamp, 'stamp')
        seen = [o if isinstance(o, _core.Observation) else inputs.observation(o.topic, stamp, o.points, o.ids)
                for o in self.observations]
        return inputs.frame(stamp, seen), checked_loads(self.loads, inputs)

    def __repr__(self):
        return '<Frame at %s s, %d observations, %d loads>' % (self.stamp, len(self.observations), len(self.loads))


@dataclass
class Recording:
    """Frames in order of time, with their loads and the mesh of the model that they were read for."""
    frames: List[Frame]
    first_stamp: float  # [s]
    mesh: _core.TetMesh
    name: str = ''


def number(value: Any, where: str, allowed: str = 'a number [s]') -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise input_error(where, repr(value), allowed) from None


def checked_loads(loads: Iterable[Union[Load, _core.LoadSample]], inputs: _core.Inputs) -> List[_core.LoadSample]:
    return [load if isinstance(load, _core.LoadSample) else inputs.load(load.topic, number(load.stamp, load.topic), load.value)
            for load in loads]


def rows(values: Any, count: int, where: str) -> np.ndarray:
    array = np.asarray(values)
    if array.ndim == 0 or len(array) != count:
        raise input_error(where, 'shape %s' % (array.shape,), '%d rows, one for each stamp' % count)
    return array


def make_frames(stamps: Any, points: Any, topic: Optional[str] = None, ids: Any = None,
                loads: Optional[Mapping[str, Any]] = None) -> List[Frame]:
    """Frames of arrays: stamps (m,) [s], points (m, n, 3) [m], ids (n,), and for each load's topic its values (m, ...)."""
    stamps = np.asarray(stamps)
    if stamps.ndim != 1:
        raise input_error('stamps', 'shape %s' % (stamps.shape,), 'shape (m,) [s]')
    points = rows(points, len(stamps), 'points')
    values = {name: rows(value, len(stamps), name) for name, value in (loads or {}).items()}
    return [Frame(stamp, points[i], topic, ids, {name: value[i] for name, value in values.items()})
            for i, stamp in enumerate(stamps)]


def make_loads(topic: str, stamps: Any, values: Any) -> List[Load]:
    """Loads of arrays, for a load that has stamps of its own: stamps (m,) [s], values (m, ...)."""
    stamps = np.asarray(stamps)
    if stamps.ndim != 1:
        raise input_error('stamps', 'shape %s' % (stamps.shape,), 'shape (m,) [s]')
    return [Load(topic, stamp, value) for stamp, value in zip(stamps, rows(values, len(stamps), topic))]


def read_bag(model: Union[_core.Model, 'PathLike'], file: 'PathLike') -> Recording:
    """Reads a rosbag for a model: frames, loads and mesh. The part of this package that can do so needs ROS's C++ libraries."""
    name = os.fspath(file)
    try:
        from ._bag import Reader
    except ImportError as error:
        raise input_error(name, 'a rosbag, which cannot be read here (%s)' % error,
                          'frames of arrays, or a build beside ROS whose setup.bash has been sourced') from None
    reader = Reader(as_model(model), name)
    frames = []
    while True:
        instant = reader.next()
        if instant is None:
            break
        frame = Frame(instant.stamp)
        frame.observations = instant.observations
        frame.loads = instant.loads
        frame.reason = instant.reason
        frames.append(frame)
    return Recording(frames, reader.first_stamp, reader.mesh, name)


def as_model(model: Union[_core.Model, 'PathLike']) -> _core.Model:
    return model if isinstance(model, _core.Model) else _core.Model(model)
