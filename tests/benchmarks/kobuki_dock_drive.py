#!/usr/bin/env python3
"""Dock with the unmodified algorithm of kobuki_auto_docking from random starts in the field of the dock.

python3 tests/benchmarks/kobuki_dock_drive.py WORKSPACE [--starts 500] [--seed 1] [--record FILE] [--unicycle]

WORKSPACE is a catkin workspace in which kobuki_dock_drive is built (yujinrobot/kobuki_core), with the
headers of Sophus in WORKSPACE/prefix/include where they are not installed. Its class DockDrive receives at
50 Hz what the simulated robot measures, as the node passes it on, and its velocity goes to the robot. With
--unicycle, the robot moves exactly as commanded, without dynamics and noise, and stops at the front of the
dock. Starts are uniform in area, 0.5 to 2.4 m before the dock and within 58 degrees, with headings up to
--heading from the direction to the dock; nothing stands in the way. A start counts as docked if the algorithm
is DONE and the robot charges.
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
from typing import Optional, Sequence, Tuple

import numpy as np
from docking import Options, Start, append, recorded, report, scene_of

from planar import Pose2, Twist2, wrap
from planar.geometry.dock_field import ROBOT_FRONT, DockField
from sim_bridge import Episode, EpisodeHooks, Simulation, SimulationSettings, StepResult, robot_named
from sim_bridge.noise import noise_named
from sim_bridge.sensors.dock_ir import DockIrProfile
from sim_bridge.sensors.kobuki import SECTOR_BITS, KobukiProfile
from sim_bridge.simulation import ROBOT_NAME

NEAREST, FARTHEST, ANGLE = 0.5, 2.4, math.radians(58.0)
SECONDS = 240.0
STATES = tuple(
    "IDLE DONE DOCKED_IN BUMPED_DOCK BUMPED SCAN FIND_STREAM GET_STREAM ALIGNED ALIGNED_FAR ALIGNED_NEAR "
    "UNKNOWN LOST".split()
)
DONE, UNKNOWN = STATES.index("DONE"), STATES.index("UNKNOWN")
# Period of the unicycle [s], its charger state and bumper; the dock's half width and the bumper's play [m].
PERIOD, CHARGING, CENTRE_BUMPER, DOCK_HALF_WIDTH, TOUCH = 0.02, 6, 2, 0.11, 0.001
# Starts of a line of the record.
BATCH = 20


def built_library(workspace: Path, folder: Path) -> ctypes.CDLL:
    """Compile the C interface against the algorithm of a workspace, and load it."""
    libraries = workspace / "devel/lib"
    packages = [manifest.parent for manifest in (workspace / "src").rglob("package.xml")]
    roots = [path / "include" for path in packages if (path / "include").is_dir()]
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

    def update(self, signals: Sequence[int], bumper: int, charger: int, base_in_odom: Pose2) -> Twist2:
        """Return the velocity after an update of the algorithm."""
        pose = map(ctypes.c_double, (base_in_odom.x, base_in_odom.y, base_in_odom.yaw))
        received = (ctypes.c_ubyte * 3)(*signals)
        state = self._library.dock_drive_update(self._drive, received, bumper, charger, *pose, self._velocity)
        if state != self.states[-1]:
            self.states.append(state)
        return Twist2(*self._velocity)

    def before_step(self, episode: Episode) -> None:
        for name in ("kobuki", "dock_ir"):
            episode.simulation.scene.robot(ROBOT_NAME).enable_sensor(name, True)

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        reading, kobuki = step.readings.get("dock_ir"), step.kobuki
        if reading is None or kobuki is None or kobuki.power is None:
            return
        bumper, charger = sum(SECTOR_BITS[each] for each in kobuki.bumpers), int(kobuki.power.charger)
        episode.command = self.update(reading.value, bumper, charger, step.odometry.base_in_odom)

    def close(self) -> None:
        """Delete the algorithm's object."""
        self._library.dock_drive_delete(self._drive)


def start_pose(rng: np.random.Generator, heading: float) -> Pose2:
    """Return a start in the field, at most ``heading`` [rad] from the direction to the dock."""
    distance = FARTHEST * math.sqrt(rng.uniform((NEAREST / FARTHEST) ** 2, 1.0))
    angle = rng.uniform(-ANGLE, ANGLE)
    yaw = wrap(angle + math.pi + rng.uniform(-heading, heading))
    return Pose2(distance * math.cos(angle), distance * math.sin(angle), yaw)


def simulated(options: Options, noise: str) -> Simulation:
    """Return a simulation of the dock and of a robot with what the algorithm needs."""
    robot, needed = robot_named("turtlebot_lidar"), (KobukiProfile, DockIrProfile)
    robot = replace(robot, sensors=tuple(each for each in robot.sensors if isinstance(each, needed)))
    settings = SimulationSettings(**noise_named(noise))
    simulation = Simulation(scene_of(0, options)[0], robot, settings, 0, Pose2(0.9, 0.0, math.pi))
    simulation.mark()
    return simulation


def run_unicycle(drive: DockDrive, base: Pose2) -> Tuple[float, bool]:
    """Dock with a robot without dynamics; return the time [s], and whether it charges at the end."""
    field, seconds, charger, odom_in_dock = DockField(), 0.0, 0, base
    while drive.states[-1] not in (DONE, UNKNOWN) and seconds < SECONDS:
        front = base @ Pose2(ROBOT_FRONT)
        charger = CHARGING if field.has_contact(base) else 0
        bumper = CENTRE_BUMPER if not charger and abs(front.y) < DOCK_HALF_WIDTH and front.x < TOUCH else 0
        base_in_odom = odom_in_dock.inverse() @ base
        velocity = drive.update(field.signals(base), bumper, charger, base_in_odom)
        moved = base @ Pose2(velocity.v * PERIOD, 0.0, velocity.omega * PERIOD)
        front = moved @ Pose2(ROBOT_FRONT)
        if velocity.v <= 0.0 or front.x >= 0.0 or abs(front.y) >= DOCK_HALF_WIDTH:
            base = moved
        seconds += PERIOD
    return seconds, bool(charger)


def run_simulated(drive: DockDrive, simulation: Simulation, seed: int, base: Pose2) -> Tuple[float, bool]:
    """Dock in the simulator; return the time [s], and whether the robot charges at the end."""
    simulation.rewind(seed, base)
    period = simulation.step_seconds
    episode = Episode(simulation, period, period, hooks=(drive,))
    step = episode.advance()
    while drive.states[-1] not in (DONE, UNKNOWN) and step.stamp < SECONDS:
        step = episode.advance()
    power = step.kobuki and step.kobuki.power
    return step.stamp, bool(power and power.charger)


def run(
    simulation: Optional[Simulation], library: ctypes.CDLL, seed: int, heading: float
) -> Tuple[Start, str]:
    """Dock from one start; return it and the states on the way.

    Args:
        simulation: The simulation; None for a robot without dynamics.
        library: The C interface.
        seed: Seed of the start.
        heading: Largest angle between the robot's heading and the direction to the dock [rad].
    """
    base, begin = start_pose(np.random.default_rng([seed, 3]), heading), time.process_time()
    drive = DockDrive(library)
    if simulation is None:
        seconds, charges = run_unicycle(drive, base)
    else:
        seconds, charges = run_simulated(drive, simulation, seed, base)
    name, path = STATES[drive.states[-1]], " ".join(STATES[state] for state in drive.states)
    drive.close()
    is_docked, pose = name == "DONE" and charges, (base.x, base.y, base.yaw)
    code = "DONE" if is_docked else f"ended in {name}"
    return Start(seed, pose, code, name, is_docked, seconds, (), time.process_time() - begin), path


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("workspace", type=Path, help="catkin workspace with kobuki_dock_drive")
    parser.add_argument("--starts", type=int, default=500, help="number of starts (default: 500)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the first start (default: 1)")
    parser.add_argument("--noise", default="turtlebot", help="noise profile (default: turtlebot)")
    parser.add_argument("--heading", type=float, default=180.0, help="largest angle [deg] (default: 180)")
    parser.add_argument("--unicycle", action="store_true", help="a robot without dynamics and noise")
    parser.add_argument("--record", type=Path, metavar="FILE", help="JSON lines, continued if it exists")
    given = parser.parse_args()
    noise = f"{'unicycle' if given.unicycle else given.noise}, headings up to {given.heading:g} degrees"
    options = Options(FARTHEST, ANGLE, 0, noise, False)
    seeds = range(given.seed, given.seed + given.starts)
    starts = [start for start in recorded(given.record, options) if start.seed in seeds]
    batch, done = [], {start.seed for start in starts}
    with tempfile.TemporaryDirectory() as folder:
        library = built_library(given.workspace.resolve(), Path(folder))
        simulation = None if given.unicycle else simulated(options, given.noise)
        for seed in seeds:
            if seed in done:
                continue
            start, path = run(simulation, library, seed, math.radians(given.heading))
            starts.append(start)
            batch.append(start)
            print(f"{seed}: {start.code} after {start.seconds:.1f} s: {path}", file=sys.stderr, flush=True)
            if given.record and (len(batch) == BATCH or seed == seeds[-1]):
                append(given.record, options, batch)
                batch.clear()
    print(report(starts))
    return 0


if __name__ == "__main__":
    sys.exit(main())
