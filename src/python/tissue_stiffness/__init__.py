"""Young's modulus of soft tissue from its motion: the C++ library in Python, without ROS.

Arrays hold SI units in the model's frame: positions (n, 3) [m], stamps [s], forces [N], pressures and moduli [Pa].
Every wrong input raises InputError, which is a ValueError and says where, what was found and what is allowed.
"""
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._core import (Estimate, Identifiability, InputError, LoadInput, LoadSample, Misfit, Model, NumericalError, Observation,
                        ParameterEstimate, Prediction, StepResult, TetMesh, build_mesh)
    from .diagnosis import Diagnosis, MissingEffect, diagnose, read_diagnosis
    from .estimation import Estimator, estimate
    from .frames import Frame, Load, Recording, make_frames, make_loads, read_bag
    from .results import FrameRecord, Result, read_results

# The messages of ROS share this package. A program that imports them alone does not wait for the library.
_SOURCES = {
    '_core': ('Estimate', 'Identifiability', 'InputError', 'LoadInput', 'LoadSample', 'Misfit', 'Model', 'NumericalError',
              'Observation', 'ParameterEstimate', 'Prediction', 'StepResult', 'TetMesh', 'build_mesh'),
    'diagnosis': ('Diagnosis', 'MissingEffect', 'diagnose', 'read_diagnosis'),
    'estimation': ('Estimator', 'estimate'),
    'frames': ('Frame', 'Load', 'Recording', 'make_frames', 'make_loads', 'read_bag'),
    'results': ('FrameRecord', 'Result', 'read_results'),
}
_SOURCE_OF = {name: source for source, names in _SOURCES.items() for name in names}
__all__ = tuple(sorted(_SOURCE_OF))


def __getattr__(name):
    if name not in _SOURCE_OF:
        raise AttributeError('module %r has no attribute %r' % (__name__, name))
    import importlib
    value = getattr(importlib.import_module('%s.%s' % (__name__, _SOURCE_OF[name])), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted(set(globals()) | set(__all__))
