"""Command line of spawn_model, as in Kinetic; unknown options are ignored with a warning."""

import argparse
from typing import List, Tuple

FLAGS = {
    "-unpause": "unpause the physics after spawning",
    "-package_to_model": "accepted without effect: package:// is supported",
    "-b": "keep running, and delete the model when interrupted",
}
VALUED = {
    "-reference_frame": "frame of the pose",
    "-gazebo_namespace": "namespace of the simulator",
    "-robot_namespace": "namespace of its topics",
    "-wait": "wait until the model of this name exists",
}
POSE = {"-x": "m", "-y": "m", "-z": "m", "-R": "roll, rad", "-P": "pitch, rad", "-Y": "yaw, rad"}
KINDS = {"-urdf": "the model is URDF", "-sdf": "the model is SDF"}
SOURCES = {
    "-file": "file with the model",
    "-param": "ROS parameter with the model",
    "-database": "model in a folder of GAZEBO_MODEL_PATH",
}
STDIN = "-stdin"
# Older names that Kinetic accepts.
ALIASES = {"-gazebo": "-sdf", "-namespace": "-robot_namespace", "-help": "-h"}
ALONE = {*FLAGS, *KINDS, STDIN, "-h", "--help"}
BEFORE_A_VALUE = {*VALUED, *POSE, *SOURCES, "-model"}


def parse(words: List[str], namespace: str) -> Tuple[argparse.Namespace, List[str]]:
    """Parse the command line of spawn_model.

    Args:
        words: The arguments.
        namespace: Default of ``-robot_namespace``.

    Returns:
        The options, and the unknown arguments.
    """
    known, unknown = _divided(words)
    return _parser(namespace).parse_args(known), unknown


def _divided(words: List[str]) -> Tuple[List[str], List[str]]:
    """Split known from unknown arguments: argparse reads ``-yaw`` as ``-y aw`` and ``-1e-3`` as an option."""
    known: List[str] = []
    unknown: List[str] = []
    rest = [ALIASES.get(word, word) for word in words]
    while rest:
        word = rest.pop(0)
        if word in ALONE:
            known.append(word)
        elif word in BEFORE_A_VALUE and rest:
            known.append(f"{word}={rest.pop(0)}")
        elif word == "-J" and len(rest) > 1:
            known += [word, rest.pop(0), rest.pop(0)]
        else:
            unknown.append(word)
    return known, unknown


def _parser(namespace: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="spawn_model", allow_abbrev=False)
    kind = parser.add_mutually_exclusive_group(required=True)
    for name, meaning in KINDS.items():
        kind.add_argument(name, action="store_true", help=meaning)
    source = parser.add_mutually_exclusive_group(required=True)
    for name, meaning in SOURCES.items():
        source.add_argument(name, help=meaning)
    source.add_argument(STDIN, action="store_true", help="the model comes from standard input")
    parser.add_argument("-model", required=True, help="name of the model")
    for name, meaning in VALUED.items():
        parser.add_argument(name, help=meaning)
    parser.set_defaults(reference_frame="", gazebo_namespace="/gazebo", robot_namespace=namespace)
    for name, meaning in FLAGS.items():
        parser.add_argument(name, action="store_true", help=meaning)
    for name, meaning in POSE.items():
        parser.add_argument(name, type=float, default=0.0, help=meaning)
    parser.add_argument("-J", nargs=2, action="append", default=[], metavar=("JOINT", "RAD_OR_M"))
    return parser
