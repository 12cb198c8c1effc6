#!/usr/bin/env python3
"""Dock with the unmodified algorithm of kobuki_auto_docking from random starts in the field of the dock.

python3 tests/benchmarks/kobuki_dock_drive.py WORKSPACE [--starts 500] [--seed 1] [--record FILE]

WORKSPACE is a catkin workspace in which kobuki_dock_drive is built (yujinrobot/kobuki_core). Its class
DockDrive receives at 50 Hz what the simulated robot measures, as the node passes it on, and its velocity goes
to the robot. Starts are uniform in area, 0.5 to 2.4 m before the dock and within 58 degrees, with any
heading; nothing stands in the way. A start counts as docked if the algorithm is DONE and the robot charges.
"""

import argparse
import ctypes
import math
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Tuple

import numpy as np
from docking import Options, Start, append, recorded, report, scene_of

from planar import Pose2, Twist2
from sim_bridge import Episode, EpisodeHooks, Simulation, SimulationSettings, StepResult, robot_named
from sim_bridge.docks import DOCK_NAME
from sim_bridge.noise import noise_named
from sim_bridge.sensors.dock_ir import DockIrProfile
from sim_bridge.sensors.kobuki import SECTOR_BITS, KobukiProfile
from sim_bridge.simulation import ROBOT_NAME

NEAREST, FARTHEST, ANGLE = 0.5, 2.4, math.radians(58.0)
SECONDS = 240.0
STATES = ("IDLE", "DONE", "DOCKED_IN", "BUMPED_DOCK", "BUMPED", "SCAN", "FIND_STREAM", "GET_STREAM")
STATES += ("ALIGNED", "ALIGNED_FAR", "ALIGNED_NEAR", "UNKNOWN", "LOST")
DONE, UNKNOWN = STATES.index("DONE"), STATES.index("UNKNOWN")
# Starts of a line of the record.
BATCH = 20


def built_library(workspace: Path, folder: Path) -> ctypes.CDLL:
    """Compile the C interface against the algorithm of a workspace, and load it."""
    libraries = workspace / "devel/lib"
    roots = [path / "include" for path in (workspace / "src").iterdir() if (path / "include").is_dir()]
    roots += [workspace / "devel/include", workspace / "prefix/include", Path("/usr/include/eigen3")]
    target = folder / "libdock_drive.so"
    source = Path(__file__).with_suffix(".cpp")
    command = ["g++", "-shared", "-fPIC", "-O2", "-w", *(f"-I{root}" for root in roots), str(source)]
    command += ["-DSOPHUS_USE_BASIC_LOGGING", f"-L{libraries}", f"-Wl,-rpath,{libraries}"]
    subprocess.run([*command, "-lkobuki_dock_drive", "-o", str(target)], check=True)
    library = ctypes.CDLL(str(target))
    library.dock_drive_new.restype = ctypes.c_void_p
    return library


class DockDrive(EpisodeHooks):
    """Passes measurements to the algorithm, and its velocity to the robot.

    Args:
        library: The C interface.
    """

    def __init__(self, library: ctypes.CDLL):
        self._library = library
        self._drive = ctypes.c_void_p(library.dock_drive_new())
        library.dock_drive_enable(self._drive)
        self._velocity = (ctypes.c_double * 2)()
        self.states = [0]

    def before_step(self, episode: Episode) -> None:
        for name in ("kobuki", "dock_ir"):
            episode.simulation.scene.robot(ROBOT_NAME).enable_sensor(name, True)

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        reading, kobuki, base = step.readings.get("dock_ir"), step.kobuki, step.odometry.base_in_odom
        if reading is None or kobuki is None or kobuki.power is None:
            return
        signals = (ctypes.c_ubyte * 3)(*reading.value)
        bumper = sum(SECTOR_BITS[sector] for sector in kobuki.bumpers)
        pose = map(ctypes.c_double, (base.x, base.y, base.yaw))
        state = self._library.dock_drive_update(
            self._drive, signals, bumper, int(kobuki.power.charger), *pose, self._velocity
        )
        if state != self.states[-1]:
            self.states.append(state)
        episode.command = Twist2(*self._velocity)

    def close(self) -> None:
        """Delete the algorithm's object."""
        self._library.dock_drive_delete(self._drive)


def start_pose(rng: np.random.Generator) -> Pose2:
    """Return a start in the field."""
    distance = FARTHEST * math.sqrt(rng.uniform((NEAREST / FARTHEST) ** 2, 1.0))
    angle = rng.uniform(-ANGLE, ANGLE)
    heading = rng.uniform(-math.pi, math.pi)
    return Pose2(distance * math.cos(angle), distance * math.sin(angle), float(heading))


def run(simulation: Simulation, library: ctypes.CDLL, seed: int) -> Tuple[Start, str]:
    """Dock from one start; return it and the states on the way."""
    base = start_pose(np.random.default_rng([seed, 3]))
    begin = time.process_time()
    simulation.rewind(seed, base)
    drive, touched = DockDrive(library), set()
    period = simulation.step_seconds
    episode = Episode(simulation, period, period, hooks=(drive,))
    while True:
        step = episode.advance()
        touched.update(name for name in step.contacts if not name.startswith(DOCK_NAME))
        if drive.states[-1] in (DONE, UNKNOWN) or step.stamp > SECONDS:
            break
    power = step.kobuki and step.kobuki.power
    is_docked = drive.states[-1] == DONE and bool(power and power.charger)
    name = STATES[drive.states[-1]]
    code, cpu = "DONE" if is_docked else f"ended in {name}", time.process_time() - begin
    path = " ".join(STATES[state] for state in drive.states)
    pose = (base.x, base.y, base.yaw)
    drive.close()
    return Start(seed, pose, code, name, is_docked, step.stamp, tuple(touched), cpu), path


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("workspace", type=Path, help="catkin workspace with kobuki_dock_drive")
    parser.add_argument("--starts", type=int, default=500, help="number of starts (default: 500)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the first start (default: 1)")
    parser.add_argument("--noise", default="turtlebot", help="noise profile (default: turtlebot)")
    parser.add_argument("--record", type=Path, metavar="FILE", help="JSON lines, continued if it exists")
    given = parser.parse_args()
    options = Options(FARTHEST, ANGLE, 0, given.noise, False)
    robot = robot_named("turtlebot_lidar")
    needed = (KobukiProfile, DockIrProfile)
    robot = replace(robot, sensors=tuple(each for each in robot.sensors if isinstance(each, needed)))
    seeds = range(given.seed, given.seed + given.starts)
    starts = [start for start in recorded(given.record, options) if start.seed in seeds]
    batch, done = [], {start.seed for start in starts}
    with tempfile.TemporaryDirectory() as folder:
        library = built_library(given.workspace.resolve(), Path(folder))
        settings = SimulationSettings(**noise_named(given.noise))
        simulation = Simulation(scene_of(0, options)[0], robot, settings, 0, Pose2(0.9, 0.0, math.pi))
        simulation.mark()
        for seed in seeds:
            if seed in done:
                continue
            start, path = run(simulation, library, seed)
            starts.append(start)
            batch.append(start)
            print(f"{seed}: {start.code} after {start.seconds:.1f} s: {path}", file=sys.stderr, flush=True)
            if given.record and (len(batch) == BATCH or seed == seeds[-1]):
                append(given.record, options, batch)
                batch.clear()
        simulation.close()
    print(report(starts))
    return 0


if __name__ == "__main__":
    sys.exit(main())
