"""Runs the experiments of Yang & Lin (2016): see scripts/paper_experiments."""
import argparse
import importlib
import os

from common import Place

EXPERIMENTS = ('heart', 'echo', 'balls', 'failures')


def main():
    parser = argparse.ArgumentParser(prog='paper_experiments')
    parser.add_argument('root')
    parser.add_argument('experiments', nargs='*', metavar='EXPERIMENT', help='of %s; all when absent' % ', '.join(EXPERIMENTS))
    parser.add_argument('--shared', help='folder with the real data; beside the repository')
    parser.add_argument('--tools', help='folder with the programs; of the build when absent')
    parser.add_argument('--output', help='folder for recordings and results; output/paper')
    arguments = parser.parse_args()
    unknown = [name for name in arguments.experiments if name not in EXPERIMENTS]
    if unknown:
        parser.error('%s is none of %s' % (unknown[0], ', '.join(EXPERIMENTS)))
    root = arguments.root
    place = Place(root, arguments.tools or os.path.join(root, 'build', 'devel', 'lib', 'tissue_stiffness'),
                  arguments.output or os.path.join(root, 'output', 'paper'),
                  os.path.abspath(arguments.shared or os.path.join(root, '..', 'shared')))
    for name in arguments.experiments or EXPERIMENTS:
        importlib.import_module(name).main(place)


if __name__ == '__main__':
    main()
