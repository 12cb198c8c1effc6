"""Looks of worlds and robots, read by a process of their own that ends when it has."""

import sys
import threading
from pathlib import Path
from subprocess import PIPE, Popen, TimeoutExpired
from typing import Callable, List, Optional, Sequence, Tuple, Union

import msgspec.msgpack

from cockpit.scene.description import SceneDescription

READING_SECONDS = 120.0
# Where processors are short, the graph goes first, but this must not starve.
NICENESS = "5"
WORLD, ROBOT, MODEL = "world", "robot", "model"
# WORLD, an SDF file, and nothing; ROBOT, its parameter, and its URDF; MODEL, its name, and its SDF or URDF.
SceneRequest = Tuple[str, str, str]
# A look, or why there is none.
SceneResult = Union[SceneDescription, str]


class SceneReader:
    """Starts the processes that read, each for all that is asked at once."""

    def __init__(self):
        self._ready: Optional[Popen] = None

    def prepare(self) -> None:
        """Starts that of the next reading: what it imports is most of its work, and can be done in time."""
        self._ready = _start()

    def rest(self) -> None:
        """Nothing is to be read soon."""
        if self._ready is not None:
            self._ready.kill()
            self._ready.communicate()
            self._ready = None

    def read_in_background(
        self, requests: Sequence[SceneRequest], take: Callable[[List[SceneResult]], None]
    ) -> None:
        """Reads in a thread, which gives ``take`` the answers."""
        process, self._ready = self._ready, None
        threading.Thread(target=lambda: take(read_scenes(requests, process)), daemon=True).start()


def read_scenes(requests: Sequence[SceneRequest], process: Optional[Popen] = None) -> List[SceneResult]:
    """By one process for all of them: that which is given, or a new one."""
    process = process or _start()
    try:
        told, complaint = process.communicate(msgspec.msgpack.encode(requests), READING_SECONDS)
    except TimeoutExpired:
        process.kill()
        process.communicate()
        return [f"was not read within {READING_SECONDS:g} s"] * len(requests)
    if process.returncode == 0:
        answers = msgspec.msgpack.decode(told)
        return [
            SceneDescription.from_bytes(answer) if isinstance(answer, bytes) else answer for answer in answers
        ]
    if len(requests) > 1:  # one of them has ended it
        return [answer for request in requests for answer in read_scenes([request])]
    lines = complaint.decode(errors="replace").strip().splitlines()
    return [lines[-1] if lines else "could not be read"]


def _start() -> Popen:
    command = ["nice", "-n", NICENESS, sys.executable, "-m", __name__]
    return Popen(command, stdin=PIPE, stdout=PIPE, stderr=PIPE)


def main() -> None:
    read = _reading()
    requests = msgspec.msgpack.decode(sys.stdin.buffer.read(), type=List[SceneRequest])
    answers = [read(*request) for request in requests]
    sys.stdout.buffer.write(msgspec.msgpack.encode(answers))


def _reading() -> Callable[[str, str, str], Union[bytes, str]]:
    """What reads a request; only the process that reads imports what that takes."""
    from cockpit.scene.reader import describe_model, describe_robot, describe_world
    from planar import PlanarError
    from sim_bridge.ros.description import find_file, model_folders

    def read(kind: str, name: str, text: str) -> Union[bytes, str]:
        try:
            if kind == WORLD:
                look = describe_world(Path(name), model_folders())
            elif kind == ROBOT:
                look = describe_robot(text, find_file)
            else:
                look = describe_model(text, name, model_folders(), find_file)
        except PlanarError as error:
            return str(error)
        return look.to_bytes()

    return read


if __name__ == "__main__":
    main()
