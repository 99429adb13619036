"""Which physics a model lacks: of arrays, or of the files that the tool `diagnose` wrote."""
import json
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Optional, Sequence, Union

from . import _core
from .errors import input_error, read_text
from .estimation import as_recording
from .frames import Frame, Load, Recording, as_model, checked_loads
from .results import read_json, real, to_parameter

if TYPE_CHECKING:
    from .frames import PathLike


@dataclass
class MissingEffect:
    """One effect of the library, assessed as the one that the model misses."""
    effect: str
    entry: str                    # entry of the model file's list `effects`
    parameters: Dict[str, float]  # by name
    log_bayes_factor: float
    p_value: float      # of the likelihood ratio with and without the effect
    size: float         # rms of what the effect explains [sigma]
    explained: float    # share of the residual's sum of squares that it explains
    probability: float  # 0 without a refit
    z: float            # statistic of the residual's test with the effect; NaN without a refit
    held_out_rms_before: float  # [m]
    held_out_rms_after: float   # [m]; NaN without a refit
    confusable_with: Dict[str, float]  # cosine by effect


@dataclass
class Diagnosis:
    """Which physics a model misses. A number that is not known is NaN."""
    complete: bool  # False: the time limit ended the search
    verdict: str    # unfinished, adequate, missing, numerics or unexplained
    set: List[str]  # the most probable effect, and those that the data cannot distinguish from it
    candidates: List[MissingEffect]  # best first
    adequate: float       # probability of the given model
    none_of_these: float  # probability that no effect of the library explains the residual
    z: float              # statistic of the test of the given model's residual
    where: str
    when: str
    next_experiment: str
    final_verdict: str        # verdict on the last step's model
    final_effects: List[str]  # effects that were added
    parameters: Dict[str, _core.ParameterEstimate]  # estimate of the last step's model by name; `std` is not known
    model_next: str  # text of the model file with the missing effects
    content: Dict[str, Any]  # diagnosis.json whole

    @property
    def probabilities(self) -> Dict[str, float]:
        """Probability of each effect that was refitted, by its name."""
        return {c.effect: c.probability for c in self.candidates if c.probability > 0.0}


def to_candidate(c: Dict[str, Any]) -> MissingEffect:
    numbers = ('log_bayes_factor', 'p_value', 'size', 'explained', 'probability', 'z', 'held_out_rms_before',
               'held_out_rms_after')
    return MissingEffect(effect=c['effect'], entry=c['entry'],
                         parameters={name: real(value) for name, value in c['parameters'].items()},
                         confusable_with={other['effect']: real(other['cosine']) for other in c['confusable_with']},
                         **{name: real(c[name]) for name in numbers})


def to_diagnosis(content: Dict[str, Any], model_next: str) -> Diagnosis:
    final = content['final']
    return Diagnosis(complete=content['complete'], verdict=content['verdict'], set=content['set'],
                     candidates=[to_candidate(c) for c in content['candidates']],
                     adequate=real(content['probability_adequate']), none_of_these=real(content['none_of_these']),
                     z=real(content['z']), where=content['where'], when=content['when'],
                     next_experiment=content['next_experiment'], final_verdict=final['verdict'],
                     final_effects=final['effects'],
                     parameters={name: to_parameter(name, p) for name, p in final.get('parameters', {}).items()},
                     model_next=model_next, content=content)


def read_diagnosis(file: 'PathLike') -> Diagnosis:
    """Reads `diagnosis.json` of the tool `diagnose`, and `model_next.yaml` beside it."""
    allowed = 'diagnosis.json of the tool `diagnose`'
    content = read_json(file, allowed)
    try:
        found = to_diagnosis(content, '')
    except (AttributeError, KeyError, TypeError) as error:
        raise input_error(os.fspath(file), 'JSON of another kind (%r)' % error, allowed) from None
    next_file = os.path.join(os.path.dirname(os.fspath(file)), 'model_next.yaml')
    found.model_next = read_text(next_file, 'model_next.yaml beside diagnosis.json')
    return found


def diagnose(model: Union[_core.Model, 'PathLike'], recording: Union['PathLike', Recording, Iterable[Frame]],
             loads: Iterable[Load] = (), add: Sequence[str] = (), ignore: Sequence[str] = (), automatic: bool = False,
             time_limit: Optional[float] = None, first_stamp: Optional[float] = None, mesh: Optional[_core.TetMesh] = None,
             progress: Optional[Callable[[str, int, int], None]] = None) -> Diagnosis:
    """Compares a model with a whole recording and says which physical effect it misses.

    recording, loads, first_stamp: as in `estimate`. add: effects to add in turn, whatever the verdict. ignore: effects not to
    search for. automatic: keep adding the most probable effect while the verdict is `missing`. time_limit: end after so many
    seconds with what is known then. progress: called with the step under way, the number of its parts that are over, and how
    many there are (0: not counted). Ctrl-C ends the search and raises KeyboardInterrupt.
    """
    if time_limit is not None and not time_limit > 0:
        raise input_error('time_limit', time_limit, '> 0 [s]')
    model = as_model(model)
    frames, first_stamp, mesh, name = as_recording(model, recording, first_stamp, mesh)
    mesh = _core.build_mesh(model) if mesh is None else mesh
    inputs = _core.Inputs(model, mesh, _core.load_inputs(model, mesh))
    all_loads, all_frames = checked_loads(loads, inputs), []
    for frame in frames:
        checked, at_frame = frame.checked(inputs)
        all_loads.extend(at_frame)
        all_frames.append(checked)
    stamps = [frame.time for frame in all_frames] + [load.time for load in all_loads]
    if first_stamp is None and stamps:
        first_stamp = min(stamps)
    kept = [frame for frame in all_frames if frame.observations and frame.time >= first_stamp + model.start]
    if not kept:
        raise input_error(name, 'no usable frame', 'at least one')
    for before, after in zip(kept, kept[1:]):
        if not after.time > before.time:
            raise input_error(name, 'a frame at %s s after one at %s s' % (after.time, before.time), 'frames in order of time')
    text, model_next = _core.diagnose(model, mesh, kept, all_loads, first_stamp, list(add), list(ignore), automatic,
                                      time_limit or 0.0, progress)
    return to_diagnosis(json.loads(text), model_next)
