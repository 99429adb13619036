"""The estimator, frame after frame or over a whole recording."""
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Optional, Tuple, Union

import numpy as np

from . import _core
from .errors import input_error
from .frames import Frame, Load, Recording, as_model, checked_loads, number, read_bag
from .results import FrameRecord, Result

if TYPE_CHECKING:
    from .frames import PathLike


class Estimator:
    """Takes frames in order of time and returns the posterior of the model's unknown parameters.

    Threads may share it: one call is served at a time, and the others run Python meanwhile. An exception leaves it as it was.
    """

    def __init__(self, model: Union[_core.Model, 'PathLike'], mesh: Optional[_core.TetMesh] = None):
        """mesh: the model's own by default."""
        self.model = as_model(model)
        self.mesh = _core.build_mesh(self.model) if mesh is None else mesh
        self._core = _core.Estimator(self.model, self.mesh)
        self._inputs = _core.Inputs(self.model, self.mesh, self._core.load_inputs())

    def step(self, frame: Frame) -> _core.StepResult:
        """Predicts, observes and updates. A frame that is late, empty or makes the model diverge is skipped with the reason."""
        return self._core.step(*frame.checked(self._inputs))

    def add_load(self, topic: str, value: Any, stamp: float) -> None:
        """Feeds a load, as in Load. Between samples loads are linear in time; outside they are held."""
        self._core.add_load(self._inputs.load(topic, number(stamp, topic), value))

    def set_first_stamp(self, stamp: float) -> None:
        """Sets the recording's first stamp [s], where that is not the first frame's or load's."""
        self._core.set_first_stamp(number(stamp, 'stamp'))

    def set_state_limits(self, converged_within: float = 0.2, stale_after: Optional[float] = None) -> None:
        """Sets the limits by which the states of later frames are judged; the estimate itself goes on.

        converged_within: relative standard deviation up to which an estimate may be converged, at most 0.2.
        stale_after: time without a measurement or a load after which the estimate is stale [s]; the model's by default.
        """
        self._core.set_state_limits(number(converged_within, 'converged_within', 'a number'),
                                    None if stale_after is None else number(stale_after, 'stale_after'))

    def reset(self) -> None:
        """Goes back to the prior; loads and frames are forgotten."""
        self._core.reset()

    @property
    def load_inputs(self) -> List[_core.LoadInput]:
        """The loads that the model's effects ask for."""
        return self._core.load_inputs()

    @property
    def estimate(self) -> _core.Estimate:
        return self._core.estimate()

    @property
    def displacement(self) -> np.ndarray:
        """Displacement of every mesh node at the last frame, (nodes, 3) [m]."""
        return self._core.displacement()

    @property
    def prediction(self) -> _core.Prediction:
        """The last frame's measurement with the model's prediction at the estimate."""
        return self._core.prediction()

    @property
    def identifiability(self) -> Dict[str, _core.Identifiability]:
        """Whether the data determine each parameter, by its name."""
        return self._core.identifiability()

    @property
    def basis_error(self) -> Optional[float]:
        """What the reduced basis leaves out of the surface's motion [m], an upper bound; None where it is not known."""
        return self._core.basis_error()

    @property
    def description(self) -> List[str]:
        """What the estimator chose by itself, one line each."""
        return self._core.description()

    def free_run(self) -> List[_core.Misfit]:
        """Misfit of each frame kept, from rest at the final estimate and never corrected."""
        return self._core.free_run()


class FreeRun:
    """Errors of the free run at the last estimate, and the noise of what was measured."""

    def __init__(self):
        self.noise, self.rows = 0.0, 0.0

    def add(self, frame: _core.Frame, sensors: List[_core.ObservationSettings]) -> None:
        for observation in frame.observations:
            self.noise += observation.count * sensors[observation.source].noise ** 2
            self.rows += observation.count

    def errors(self, misfits: List[_core.Misfit]) -> Tuple[float, float, float]:
        """rms error [m], rms noise [m], and rms error over rms motion."""
        lengths = np.array([m.lengths for m in misfits], float)
        error = np.dot(lengths, np.square([m.rms for m in misfits])) if misfits else np.nan
        motion = np.dot(lengths, np.square([m.motion_rms for m in misfits])) if misfits else np.nan
        with np.errstate(divide='ignore', invalid='ignore'):
            return (float(np.sqrt(np.divide(error, lengths.sum()))), float(np.sqrt(np.divide(self.noise, self.rows))),
                    float(np.sqrt(np.divide(error, motion))))


def as_recording(model: _core.Model, recording: Any, first_stamp: Optional[float],
                 mesh: Optional[_core.TetMesh]) -> Tuple[Iterable[Frame], Optional[float], Optional[_core.TetMesh], str]:
    """Frames, first stamp, mesh and name of a bag's name, of a Recording or of frames."""
    if isinstance(recording, (str, os.PathLike)):
        recording = read_bag(model, recording)
    if isinstance(recording, Recording):
        first_stamp = recording.first_stamp if first_stamp is None else first_stamp
        return recording.frames, first_stamp, recording.mesh if mesh is None else mesh, recording.name
    return recording, first_stamp, mesh, 'arrays'


def estimate(model: Union[_core.Model, 'PathLike'], recording: Union['PathLike', Recording, Iterable[Frame]],
             loads: Iterable[Load] = (), first_stamp: Optional[float] = None, mesh: Optional[_core.TetMesh] = None,
             progress: Optional[Callable[[int], None]] = None) -> Result:
    """Estimates from a whole recording: a rosbag's name, what read_bag returned, or frames in order of time.

    loads: loads beside those of the frames. first_stamp: the recording's [s], where that is not the first frame's or load's.
    progress: called after each frame with the number of frames so far.
    """
    model = as_model(model)
    frames, first_stamp, mesh, name = as_recording(model, recording, first_stamp, mesh)
    estimator = Estimator(model, mesh)
    if first_stamp is not None:
        estimator.set_first_stamp(first_stamp)
    for load in checked_loads(loads, estimator._inputs):
        estimator._core.add_load(load)
    records: List[FrameRecord] = []
    run = FreeRun()
    for frame in frames:
        checked, at_frame = frame.checked(estimator._inputs)
        step = estimator._core.step(checked, at_frame)
        if step.used:
            run.add(checked, model.observations)
        reason = step.reason if frame.observations else frame.reason or step.reason
        records.append(FrameRecord(checked.time, step.used, step.state, tuple(step.estimate.parameters),
                                   step.misfit.rms_sigma if step.used else float('nan'), reason))
        if progress is not None:
            progress(len(records))
    if not any(record.used for record in records):
        raise input_error(name, 'no usable frame (%s)' % (records[-1].reason if records else 'it is empty'), 'at least one')
    rms_error, noise_rms, relative_error = run.errors(estimator.free_run())
    last, basis_error = estimator.estimate, estimator.basis_error
    return Result(model=model.name, recording=name, complete=True, state=last.state, state_reason=last.state_reason,
                  parameters={p.name: p for p in last.parameters}, identifiable=estimator.identifiability, rms_error=rms_error,
                  noise_rms=noise_rms, relative_error=relative_error,
                  basis_error=float('nan') if basis_error is None else basis_error, frames=records)
