"""The folder of one draw of a study: its models and its truth, which are written once, and what `estimate` finds there."""
import json
import os

import yaml

from tool_runs import call


def file_name(case):
    return case.replace(', ', '_').replace(' ', '_')


def begin_draw(folder):
    """Makes the folder. Returns whether the draw has still to be made; its truth is written last."""
    os.makedirs(folder, exist_ok=True)
    return not os.path.exists(os.path.join(folder, 'truth.json'))


def write_model(folder, model, case='model'):
    with open(os.path.join(folder, file_name(case) + '.yaml'), 'w') as file:
        yaml.safe_dump(model, file, default_flow_style=None, sort_keys=False)


def write_truth(folder, truth):
    with open(os.path.join(folder, 'truth.json'), 'w') as file:
        json.dump(truth, file)


def read_truth(folder):
    with open(os.path.join(folder, 'truth.json')) as file:
        return json.load(file)


def estimated(program, folder, case='model', bags=('recording.bag',), options=()):
    """Returns the results of `estimate` with a case's model on bags of the folder. Raises Failed where it gives none."""
    out = os.path.join(folder, file_name(case))
    call([program, out + '.yaml', *(os.path.join(folder, bag) for bag in bags), '--output', out, *options])
    with open(os.path.join(out, 'results.json')) as file:
        return json.load(file)
