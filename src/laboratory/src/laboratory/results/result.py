"""What a run came to, as it is kept."""

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
    """What a result is of: the digest of a scenario, a seed, the version of the software."""

    digest: str
    seed: int
    version: str


@dataclass(frozen=True)
class RunResult:
    """Lengths in metres, ``seconds`` simulated; what a run has not is None.

    ``way``: the shortest that there was, ``clearance``: the least between the robot's middle and anything
    solid, ``turning``: rad turned for each metre driven, ``score``: of a benchmark. ``hash``: the same for
    two runs only if every bit of their true trajectories is. ``track``: (N, 4) float32, thinned, as bytes.
    ``still``: seconds without moving. ``ran_into_robot``: how many people did; what follows it is told in
    laboratory.results.social_metrics.
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
    """Measures a run."""
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
    """A run that could not be played."""
    text = str(error) or type(error).__name__
    return RunResult(**key._asdict(), outcome=ERROR, reason=text.splitlines()[0])


def clearance(world: World, track: np.ndarray) -> Optional[float]:
    """The least distance, metres, from the places of a track (N, 4) to what is solid; None if nothing is."""
    field = _distances(world, float(track[0, 1]), float(track[0, 2]))
    if field is None:
        return None
    grid, distances = field
    cells = grid.cells_of(track[:, 1:3])
    cells = cells[grid.contains(cells)]
    return float(distances[cells[:, 0], cells[:, 1]].min()) if len(cells) else None


@lru_cache(maxsize=8)
def _distances(world: World, x: float, y: float):
    """The true map of a world, and the distance of its cells from what is solid; None if there is nothing."""
    try:
        grid: OccupancyGrid = true_map(world, inside=(x, y))
    except WorldError:
        return None
    return grid, distance_field(grid.cells == OCCUPIED, grid.resolution)


def thinned(rows: np.ndarray) -> np.ndarray:
    """At most MOST_TRACKED rows, evenly chosen, the first and the last among them."""
    if len(rows) <= MAX_TRACK_POSES:
        return rows
    return rows[np.linspace(0, len(rows) - 1, MAX_TRACK_POSES).round().astype(int)]


def track_of(result: RunResult) -> np.ndarray:
    """(N, 4) stamp, x, y, yaw."""
    return np.frombuffer(result.track, dtype=np.float32).reshape(-1, 4)
