"""Result of a run, as it is stored."""

import hashlib
from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import NamedTuple, Optional

import numpy as np

from laboratory.results.social_metrics import seconds_still, social_metrics
from laboratory.tasks.task import COLLISION, ERROR, SUCCESS, RunTrace
from laboratory.worlds.source import Arena
from planar import OCCUPIED, OccupancyGrid, wrap
from planar.geometry.distance_field import distance_field
from sim_bridge.errors import WorldError
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World


class RunKey(NamedTuple):
    """Identity of a run: digest of the scenario, seed and version of the software."""

    digest: str
    seed: int
    version: str


@dataclass(frozen=True)
class RunResult:
    """Result of a run. Field names are the columns of the stored table; values that do not apply are None.

    Attributes:
        digest: Digest of the scenario.
        seed: Seed of the run.
        version: Version of the software.
        outcome: One of ``laboratory.tasks.task.OUTCOMES``.
        reason: Why the run ended so.
        arena: Title of the world.
        arena_number: Number of the world; equal for seeds with the same world.
        seconds: Simulated time [s].
        driven: Length of the true trajectory [m].
        way: Length of the shortest path [m].
        clearance: Minimum distance between the robot's centre and an obstacle [m].
        turning: Rotation per distance [rad/m].
        localization_mean: Mean localization error [m].
        localization_max: Maximum localization error [m].
        score: Score of the benchmark.
        collisions: Number of bodies the robot collided with.
        end_x: Final x of the robot in the world frame [m].
        end_y: Final y of the robot in the world frame [m].
        hash: Hash of the true trajectory; equal only if every bit of it is.
        wall_seconds: Wall-clock time [s].
        track: Thinned true trajectory (N, 4) of stamp, x, y, yaw as float32 bytes.
        still: Time without motion [s].
        ran_into_robot: Number of pedestrians who touched the robot by their own fault.
        intimate: See ``SocialMetrics``, as for the fields that follow.
    """

    digest: str
    seed: int
    version: str
    outcome: str
    reason: str
    arena: str = ""
    arena_number: int = 0
    seconds: Optional[float] = None
    driven: Optional[float] = None
    way: Optional[float] = None
    clearance: Optional[float] = None
    turning: Optional[float] = None
    localization_mean: Optional[float] = None
    localization_max: Optional[float] = None
    score: Optional[float] = None
    collisions: int = 0
    end_x: Optional[float] = None
    end_y: Optional[float] = None
    hash: str = ""
    wall_seconds: float = 0.0
    track: bytes = b""
    still: Optional[float] = None
    ran_into_robot: Optional[int] = None
    intimate: Optional[float] = None
    personal: Optional[float] = None
    social: Optional[float] = None
    person_nearest: Optional[float] = None
    person_distance: Optional[float] = None
    social_work: Optional[float] = None

    @property
    def is_success(self) -> bool:
        return self.outcome == SUCCESS


MAX_TRACK_POSES = 400


def measured_result(
    trace: RunTrace, arena: Arena, arena_number: int, key: RunKey, wall_seconds: float
) -> RunResult:
    """Compute the result of a run from its trace."""
    track = trace.trajectory
    steps = np.diff(track, axis=0)
    driven = float(np.hypot(steps[:, 1], steps[:, 2]).sum())
    errors = trace.localization_error
    return RunResult(
        **key._asdict(),
        outcome=trace.outcome,
        reason=trace.reason,
        arena=arena.title,
        arena_number=arena_number,
        seconds=float(track[-1, 0]),
        driven=driven,
        way=trace.reference_length,
        clearance=clearance(arena.world, track),
        turning=float(np.abs(wrap(steps[:, 3])).sum()) / driven if driven > 0.0 else None,
        localization_mean=float(errors.mean()) if len(errors) else None,
        localization_max=float(errors.max()) if len(errors) else None,
        score=trace.score,
        collisions=len(set(trace.collisions)) or int(trace.outcome == COLLISION),
        end_x=float(track[-1, 1]),
        end_y=float(track[-1, 2]),
        hash=hashlib.sha256(np.ascontiguousarray(track).tobytes()).hexdigest()[:16],
        wall_seconds=wall_seconds,
        track=thinned(track).astype(np.float32).tobytes(),
        still=seconds_still(track),
        ran_into_robot=len(trace.people_at_fault) if arena.world.walkers else None,
        **asdict(social_metrics(track, trace.people)),
    )


def error_result(error: BaseException, key: RunKey) -> RunResult:
    """Return the result of a run that could not be executed."""
    text = str(error) or type(error).__name__
    return RunResult(**key._asdict(), outcome=ERROR, reason=text.splitlines()[0])


def clearance(world: World, track: np.ndarray) -> Optional[float]:
    """Return the minimum distance of a track (N, 4) to obstacles [m]; None without obstacles."""
    field = _distances(world, float(track[0, 1]), float(track[0, 2]))
    if field is None:
        return None
    grid, distances = field
    cells = grid.cells_of(track[:, 1:3])
    cells = cells[grid.contains(cells)]
    return float(distances[cells[:, 0], cells[:, 1]].min()) if len(cells) else None


@lru_cache(maxsize=8)
def _distances(world: World, x: float, y: float):
    """The true map of a world with its distance field; None if the world has no obstacles."""
    try:
        grid: OccupancyGrid = true_map(world, inside=(x, y))
    except WorldError:
        return None
    return grid, distance_field(grid.cells == OCCUPIED, grid.resolution)


def thinned(rows: np.ndarray) -> np.ndarray:
    """Return at most MAX_TRACK_POSES evenly spaced rows, including the first and the last."""
    if len(rows) <= MAX_TRACK_POSES:
        return rows
    return rows[np.linspace(0, len(rows) - 1, MAX_TRACK_POSES).round().astype(int)]


def track_of(result: RunResult) -> np.ndarray:
    """Return the track of a result: (N, 4) stamp, x, y, yaw."""
    return np.frombuffer(result.track, dtype=np.float32).reshape(-1, 4)
