"""Results of an estimation run: of arrays, or of the files that the tool `estimate` wrote."""
import csv
import io
import json
import os
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from ._core import Identifiability, ParameterEstimate
from .errors import input_error, read_text

if TYPE_CHECKING:
    from .frames import PathLike

COLUMN = re.compile(r'(?P<name>.*)\.(?P<part>mean|std|lower95|upper95) \[(?P<unit>[^\]]*)\]')


class FrameRecord(NamedTuple):
    """One frame of a run."""
    stamp: float  # [s]
    used: bool    # False: skipped for `reason`
    state: str
    parameters: Tuple[ParameterEstimate, ...]  # the posterior after this frame
    misfit: float  # rms of error over noise [-]; NaN where the frame was skipped
    reason: str


@dataclass
class Result:
    """What an estimation run gives. A number that does not exist is NaN."""
    model: str
    recording: str
    complete: bool  # False: the run was interrupted
    state: str      # no_data, converging, converged, doubtful, drifting, stale or model_invalid
    state_reason: str
    parameters: Dict[str, ParameterEstimate]  # by name
    identifiable: Dict[str, Identifiability]  # by parameter name
    rms_error: float       # of the free run at the final estimate [m]
    noise_rms: float       # noise of the sensors, as stated in the model file [m]
    relative_error: float  # rms error over rms motion [-]
    basis_error: float     # of the reduced basis, an upper bound [m]
    frames: List[FrameRecord]

    @property
    def young_modulus(self) -> float:
        """Mean of the only Young's modulus [Pa]. Raises InputError unless there is exactly one."""
        return self.parameters[self._modulus()].mean

    @property
    def interval(self) -> Tuple[float, float]:
        """95 % interval of the only Young's modulus [Pa]."""
        p = self.parameters[self._modulus()]
        return p.lower95, p.upper95

    def moduli(self) -> List[str]:
        """Names of the estimated Young's moduli."""
        return [name for name in self.parameters if name.endswith('.young_modulus')]

    def _modulus(self) -> str:
        names = self.moduli()
        if len(names) != 1:
            raise input_error('parameter', '%d moduli' % len(names), 'the name of one: %s' % ', '.join(self.parameters))
        return names[0]

    def columns(self, parameter: Optional[str] = None) -> Dict[str, np.ndarray]:
        """One entry for each frame: stamp [s], E [Pa], lower and upper end of its 95 % interval [Pa], state, misfit [-], used.

        parameter: name of the one to show, the only Young's modulus by default; another parameter's column has its own name.
        """
        name = self._modulus() if parameter is None else parameter
        if name not in self.parameters:
            raise input_error('parameter', name, ', '.join(self.parameters))
        series = [{p.name: p for p in frame.parameters}.get(name) for frame in self.frames]

        def numbers(part: str) -> np.ndarray:
            return np.array([np.nan if p is None else getattr(p, part) for p in series], float)
        title = 'E' if name.endswith('.young_modulus') else name.rsplit('.', 1)[-1]
        return {
            'stamp': np.array([frame.stamp for frame in self.frames], float),
            title: numbers('mean'), 'lower': numbers('lower95'), 'upper': numbers('upper95'),
            'state': np.array([frame.state for frame in self.frames], object),
            'misfit': np.array([frame.misfit for frame in self.frames], float),
            'used': np.array([frame.used for frame in self.frames], bool),
        }

    def table(self, parameter: Optional[str] = None) -> Any:
        """`columns` as a pandas DataFrame; without pandas the columns themselves."""
        columns = self.columns(parameter)
        try:
            import pandas
        except ImportError:
            return columns
        return pandas.DataFrame(columns)

    def plot(self, file: Optional['PathLike'] = None, parameter: Optional[str] = None) -> Any:
        """Draws each Young's modulus, or one parameter, over time with its 95 % interval. Writes an image where a file is named.

        Returns matplotlib's Figure.
        """
        from matplotlib import pyplot
        names = (self.moduli() or list(self.parameters)) if parameter is None else [parameter]
        figure, axes = pyplot.subplots(len(names), squeeze=False, sharex=True, figsize=(7, 1 + 2.5 * len(names)))
        for name, axis in zip(names, axes[:, 0]):
            columns = self.columns(name)
            stamps, mean = columns['stamp'], columns[list(columns)[1]]
            since = stamps - stamps[0] if len(stamps) else stamps
            axis.fill_between(since, columns['lower'], columns['upper'], alpha=0.3, linewidth=0, label='95 % interval')
            axis.plot(since, mean, label='mean')
            if columns['lower'].size and np.nanmin(columns['lower']) > 0:  # the first intervals span decades
                axis.set_yscale('log')
            axis.set_ylabel('%s [%s]' % (name, self.parameters[name].unit))
            axis.legend()
        axes[-1, 0].set_xlabel('time since the first frame [s]')
        axes[0, 0].set_title(self.state)
        figure.tight_layout()
        if file is not None:
            figure.savefig(os.fspath(file))
        return figure


def real(value: Any) -> float:
    """A number of the tools' JSON or CSV, where one that does not exist is null or empty."""
    return float('nan') if value is None or value == '' else float(value)


def read_json(file: 'PathLike', allowed: str) -> Dict[str, Any]:
    text = read_text(file, allowed)
    try:
        content = json.loads(text)
    except ValueError as error:
        raise input_error(os.fspath(file), 'no JSON (%s)' % error, allowed) from None
    if not isinstance(content, dict):
        raise input_error(os.fspath(file), 'JSON without keys', allowed)
    return content


def to_parameter(name: str, p: Dict[str, Any]) -> ParameterEstimate:
    lower, upper = p['interval95']
    return ParameterEstimate(name, p['unit'], real(p['mean']), real(p.get('std')), real(lower), real(upper))


def read_frames(file: 'PathLike') -> List[FrameRecord]:
    """Reads `estimates.csv`."""
    allowed = 'estimates.csv of the tool `estimate`, beside results.json'
    table = list(csv.reader(io.StringIO(read_text(file, allowed), newline='')))
    try:
        header, lines = table[0], table[1:]
        at = {title: i for i, title in enumerate(header)}
        stamp, used, state, misfit, reason = (at[title] for title in (
            'time [s]', 'used', 'state', 'misfit_rms [sigma]', 'reason'))
        means = [(i, match) for i, match in enumerate(map(COLUMN.fullmatch, header)) if match and match['part'] == 'mean']
        return [FrameRecord(float(line[stamp]), line[used] == '1', line[state],
                            tuple(ParameterEstimate(match['name'], match['unit'], *map(real, line[i:i + 4]))
                                  for i, match in means),
                            real(line[misfit]), line[reason]) for line in lines]
    except (IndexError, KeyError, ValueError) as error:
        raise input_error(os.fspath(file), 'another table (%s)' % error, allowed) from None


def read_results(file: 'PathLike') -> Result:
    """Reads `results.json` of the tool `estimate`, and the frames from `estimates.csv` beside it."""
    allowed = 'results.json of the tool `estimate`'
    content = read_json(file, allowed)
    try:
        return Result(
            model=content['model'], recording=content['recording'], complete=content['complete'], state=content['state'],
            state_reason=content['state_reason'],
            parameters={name: to_parameter(name, p) for name, p in content['parameters'].items()},
            identifiable={name: Identifiability(i['verdict'], i['reason']) for name, i in content['identifiable'].items()},
            rms_error=real(content['rms_error']), noise_rms=real(content['noise_rms']),
            relative_error=real(content['relative_error']), basis_error=real(content['basis_error']),
            frames=read_frames(os.path.join(os.path.dirname(os.fspath(file)), 'estimates.csv')))
    except (AttributeError, KeyError, TypeError) as error:
        raise input_error(os.fspath(file), 'JSON of another kind (%r)' % error, allowed) from None
