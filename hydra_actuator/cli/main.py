# SPDX-License-Identifier: Apache-2.0
"""
Find the verb, parse its arguments, run it, turn its outcome into an exit code.

Only the module of the verb in use is imported. Such a module offers

- `SUMMARY`: one line, the same as in the table below,
- `add_arguments(parser)`,
- `run(arguments) -> int`: the exit code; heavy imports belong in here,
- `prepare()`, optional: called before anything else is imported or parsed (signal handlers),
- `ROS_ARGUMENTS = True`, optional: everything from `--ros-args` to `--` or the end is not
  parsed but handed over as the list `arguments.ros_arguments`.
"""

from importlib import import_module
import sys

from hydra_actuator.errors import Failure, InputError

VERBS = {
    'node': 'the actuator as a ROS 2 node; takes --ros-args',
    'demo': 'the node in real time, driven over DDS, recorded and reported',
    'simulate': 'an offline run, as fast as possible, into a recording',
    'report': 'one self-contained page about a recording, or a sweep',
    'plot': 'one figure of a recording as PNG, SVG or PDF',
    'animate': 'the actuator in motion, oil coloured by pressure, as GIF, MP4 or HTML',
    'watch': 'a live view of a running node in the terminal',
    'info': 'what a recording holds',
    'export': 'a recording as CSV, Parquet or NetCDF, with units',
    'recover': 'salvage of an unfinished or damaged recording',
    'paper': 'every figure of the paper, and its statements beside our numbers',
    'verify': 'the solver against exact solutions and conservation laws',
    'response': 'frequency response about an operating point, null curves of the valve',
    'sweep': 'many simulations over parameters, on Dask: local, or a cluster',
    'bench': 'speed of the solver',
}

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


def main(argv: list[str] | None = None) -> int:
    """Run `hydra_actuator VERB ...` and return the exit code."""
    argv = sys.argv[1:] if argv is None else list(argv)
    if not argv or argv[0] in ('-h', '--help', 'help'):
        print(_overview())
        return DONE if argv else BAD_INPUT
    if argv[0] == '--version':
        print(import_module('hydra_actuator').__version__)
        return DONE
    if argv[0] not in VERBS:
        return _refuse('', f'no verb {argv[0]!r}; there are {", ".join(VERBS)}', BAD_INPUT)
    return _guarded(argv[0], argv[1:])


def node_main(argv: list[str] | None = None) -> int:
    """Run the node: what the executable `actuator_node` does."""
    return main(['node', *(sys.argv[1:] if argv is None else argv)])


def split_ros_arguments(argv: list[str]) -> tuple[list[str], list[str]]:
    """
    Return (own arguments, ROS arguments).

    ROS arguments run from `--ros-args` to `--` or the end, any number of times; the markers
    stay with them.
    """
    own: list[str] = []
    ros: list[str] = []
    inside = False
    for argument in argv:
        inside = inside or argument == '--ros-args'
        (ros if inside else own).append(argument)
        inside = inside and argument != '--'
    return own, ros


def _guarded(verb: str, argv: list[str]) -> int:
    """Run one verb; a foreseen error becomes one line on stderr and its exit code."""
    try:
        return _run(verb, argv)
    except InputError as error:
        return _refuse(verb, error, BAD_INPUT)
    except Failure as error:
        return _refuse(verb, error, FAILED)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of our output is gone, as in `hydra_actuator info ... | head`. What Python
        # still holds for it must not be flushed at exit.
        sys.stdout = None
        return DONE


def _run(verb: str, argv: list[str]) -> int:
    """Import the verb's module, parse, run."""
    module = import_module(f'hydra_actuator.cli.{verb}')
    prepare = getattr(module, 'prepare', None)
    if prepare is not None:
        prepare()
    own, ros = argv, []
    if getattr(module, 'ROS_ARGUMENTS', False):
        own, ros = split_ros_arguments(argv)
    parser = _parser(verb)
    module.add_arguments(parser)
    arguments = parser.parse_args(own)
    arguments.ros_arguments = ros
    code = module.run(arguments)
    if sys.stdout is not None:
        sys.stdout.flush()
    return code


def _parser(verb: str):
    """Return an argparse parser whose complaint is an InputError: one line, not the usage."""
    import argparse

    class Parser(argparse.ArgumentParser):

        def error(self, message: str):
            raise InputError(message)

    return Parser(prog=f'hydra_actuator {verb}', description=VERBS[verb])


def _overview() -> str:
    """Return the list of verbs."""
    width = max(map(len, VERBS))
    verbs = '\n'.join(f'  {verb:<{width}}  {summary}' for verb, summary in VERBS.items())
    return (
        'usage: hydra_actuator VERB [arguments]; hydra_actuator VERB --help tells them\n\n'
        f'{verbs}'
    )


def _refuse(verb: str, message: object, code: int) -> int:
    """Print one line on stderr and return the exit code."""
    line = ' '.join(str(message).split())
    print(f'hydra_actuator {verb}'.rstrip() + f': {line}', file=sys.stderr)
    return code
