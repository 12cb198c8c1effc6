"""Looks of worlds and robots, read by a process of their own that ends when it has."""

import subprocess
import sys
import threading
from pathlib import Path
from typing import Callable, Optional

from cockpit.errors import CockpitError
from cockpit.scene.look import Look

READING_SECONDS = 120.0
WORLD, ROBOT = "world", "robot"


def read_look(kind: str, text: str) -> Look:
    """Of the SDF file named ``text``, or of the robot whose URDF it is. Raises CockpitError."""
    command = ["nice", sys.executable, "-m", __name__, kind]
    try:
        done = subprocess.run(command, input=text.encode(), capture_output=True, timeout=READING_SECONDS)
    except subprocess.TimeoutExpired:
        raise CockpitError(f"the {kind} was not read within {READING_SECONDS:g} s") from None
    if done.returncode != 0:
        lines = done.stderr.decode(errors="replace").strip().splitlines()
        raise CockpitError(lines[-1] if lines else f"the {kind} could not be read")
    return Look.from_bytes(done.stdout)


def read_aside(kind: str, text: str, take: Callable[[Optional[Look], str], None]) -> None:
    """Reads in a thread; ``take`` is given the look, or None and why there is none."""

    def read():
        try:
            look = read_look(kind, text)
        except CockpitError as error:
            take(None, str(error))
        else:
            take(look, "")

    threading.Thread(target=read, daemon=True).start()


def main() -> None:
    from cockpit.scene.reading import robot_look, world_look
    from planar import PlanarError
    from sim_bridge.ros.cli import find_file, model_folders

    text = sys.stdin.buffer.read().decode(errors="replace")
    try:
        if sys.argv[1] == WORLD:
            look = world_look(Path(text), model_folders())
        else:
            look = robot_look(text, find_file)
    except PlanarError as error:
        sys.exit(str(error))
    sys.stdout.buffer.write(look.to_bytes())


if __name__ == "__main__":
    main()
