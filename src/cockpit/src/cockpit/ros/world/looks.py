"""Looks of worlds and robots, read by a process of their own that ends when it has."""

import subprocess
import sys
import threading
from pathlib import Path
from typing import Callable, List, Sequence, Tuple, Union

import msgspec.msgpack

from cockpit.scene.look import Look

READING_SECONDS = 120.0
# Where processors are short, the graph goes first, but this must not starve.
NICENESS = "5"
WORLD, ROBOT, MODEL = "world", "robot", "model"
# WORLD, an SDF file, and nothing; ROBOT, its parameter, and its URDF; MODEL, its name, and its SDF or URDF.
Request = Tuple[str, str, str]
# A look, or why there is none.
Answer = Union[Look, str]


def read_looks(requests: Sequence[Request]) -> List[Answer]:
    """By one process for all of them: what it needs to read is most of the work."""
    try:
        done = subprocess.run(
            ["nice", "-n", NICENESS, sys.executable, "-m", __name__],
            input=msgspec.msgpack.encode(requests),
            capture_output=True,
            timeout=READING_SECONDS,
        )
    except subprocess.TimeoutExpired:
        return [f"was not read within {READING_SECONDS:g} s"] * len(requests)
    if done.returncode == 0:
        answers = msgspec.msgpack.decode(done.stdout)
        return [Look.from_bytes(answer) if isinstance(answer, bytes) else answer for answer in answers]
    if len(requests) > 1:  # one of them has ended it
        return [answer for request in requests for answer in read_looks([request])]
    lines = done.stderr.decode(errors="replace").strip().splitlines()
    return [lines[-1] if lines else "could not be read"]


def read_aside(requests: Sequence[Request], take: Callable[[List[Answer]], None]) -> None:
    """Reads in a thread, which gives ``take`` the answers."""
    threading.Thread(target=lambda: take(read_looks(requests)), daemon=True).start()


def main() -> None:
    requests = msgspec.msgpack.decode(sys.stdin.buffer.read(), type=List[Request])
    answers = [_read(*request) for request in requests]
    sys.stdout.buffer.write(msgspec.msgpack.encode(answers))


def _read(kind: str, name: str, text: str) -> Union[bytes, str]:
    from cockpit.scene.reading import model_look, robot_look, world_look
    from planar import PlanarError
    from sim_bridge.ros.describing import find_file, model_folders

    try:
        if kind == WORLD:
            look = world_look(Path(name), model_folders())
        elif kind == ROBOT:
            look = robot_look(text, find_file)
        else:
            look = model_look(text, name, model_folders(), find_file)
    except PlanarError as error:
        return str(error)
    return look.to_bytes()


if __name__ == "__main__":
    main()
