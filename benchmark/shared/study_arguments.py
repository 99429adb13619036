"""What the studies on truths of the independent simulator are told on the command line."""
import os


def study_arguments(parser, program, output):
    """Parses root, --output (default: root/output/OUTPUT) and --PROGRAM (default: the one of the build) beside the parser's
    own options, and says where the simulator is."""
    parser.add_argument('root')
    parser.add_argument('--output')
    parser.add_argument('--' + program, help='the program that is studied')
    arguments = parser.parse_args()
    arguments.simulator = os.path.join(arguments.root, '..', 'shared', 'simulator')
    arguments.output = os.path.abspath(arguments.output or os.path.join(arguments.root, 'output', output))
    if getattr(arguments, program) is None:
        setattr(arguments, program, os.path.join(arguments.root, 'build/devel/lib/tissue_stiffness', program))
    return arguments
