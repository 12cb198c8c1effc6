"""Read worlds and robots in a child process that exits when it is done."""

import sys
import threading
from pathlib import Path
from subprocess import PIPE, Popen, TimeoutExpired
from typing import Callable, List, Optional, Sequence, Tuple, Union

import msgspec.msgpack

from cockpit.scene.description import SceneDescription

READING_SECONDS = 120.0
# The graph has priority on a busy machine, but reading must not starve.
NICENESS = "5"
WORLD, ROBOT, MODEL = "world", "robot", "model"
# (WORLD, SDF file or description, ""), (ROBOT, parameter, URDF) or (MODEL, name, SDF or URDF).
SceneRequest = Tuple[str, str, str]
# The description, or the reason why it could not be read.
SceneResult = Union[SceneDescription, str]


class SceneReader:
    """Starts a child process for each batch of requests."""

    def __init__(self):
        self._ready: Optional[Popen] = None

    def prepare(self) -> None:
        """Start the next child process early: importing takes most of its time."""
        self._ready = _start()

    def stop(self) -> None:
        """Stop the prepared child process."""
        if self._ready is not None:
            self._ready.kill()
            self._ready.communicate()
            self._ready = None

    def read_in_background(
        self, requests: Sequence[SceneRequest], on_results: Callable[[List[SceneResult]], None]
    ) -> None:
        """Read worlds and robots in a thread.

        Args:
            requests: What to read.
            on_results: Called from that thread with the results, in the order of the requests.
        """
        process, self._ready = self._ready, None
        threading.Thread(target=lambda: on_results(read_scenes(requests, process)), daemon=True).start()


def read_scenes(requests: Sequence[SceneRequest], process: Optional[Popen] = None) -> List[SceneResult]:
    """Read worlds and robots in one child process.

    Args:
        requests: What to read.
        process: A prepared child process; None to start one.

    Returns:
        A description for each request, or a text why it cannot be read.
    """
    process = process or _start()
    try:
        output, errors = process.communicate(msgspec.msgpack.encode(requests), READING_SECONDS)
    except TimeoutExpired:
        process.kill()
        process.communicate()
        return [f"was not read within {READING_SECONDS:g} s"] * len(requests)
    if process.returncode == 0:
        answers = msgspec.msgpack.decode(output)
        return [
            SceneDescription.from_bytes(answer) if isinstance(answer, bytes) else answer for answer in answers
        ]
    if len(requests) > 1:  # one of them has crashed the process
        return [answer for request in requests for answer in read_scenes([request])]
    lines = errors.decode(errors="replace").strip().splitlines()
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
    """Return the function that reads a request; only the child process imports the physics packages."""
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
