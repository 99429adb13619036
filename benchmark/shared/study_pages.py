"""What the studies on truths of the independent simulator have in common in what they count and write."""
import os

import numpy as np


def judged_modulus(result, truth):
    """E's relative error, whether its interval holds the truth [Pa], its half width over E, and the state."""
    found = result['parameters']['elasticity.young_modulus']
    low, high = found['interval95']
    return {'error': found['mean'] / truth - 1.0, 'inside': bool(low <= truth <= high), 'width': 0.5 * (high - low) / found['mean'],
            'state': result.get('state', '')}


def summary_row(name, rows, wanted):
    """Case, draws, those that are converged, their median and largest error, what is wanted, and intervals that hold."""
    told = [abs(r['error']) for r in rows if r['state'] == 'converged']
    return '| %s | %d | %d | %s | %s | %.0f %% | %d of %d |' % (
        name, len(rows), len(told), '%.1f %%' % (100 * np.median(told)) if told else '', '%.1f %%' % (100 * max(told)) if told else '',
        100 * wanted, sum(r['inside'] for r in rows), len(rows))


def write_page(arguments, name, text):
    """Prints a page and writes it into doc."""
    print('\n' + text)
    with open(os.path.join(arguments.root, 'doc', name), 'w') as file:
        file.write(text)
