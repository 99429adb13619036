"""The common style of all figures."""
import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402


def save(figure, path, dpi=90, bare=()):
    """Writes and closes a figure; the axes in `bare` lose the frame's right and upper side."""
    for axis in bare:
        for side in ('top', 'right'):
            axis.spines[side].set_visible(False)
    figure.tight_layout()
    figure.savefig(path, dpi=dpi)
    plt.close(figure)
