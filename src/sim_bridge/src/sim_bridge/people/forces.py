"""What moves people (social force: Helbing and Molnar, 1995; the way one gives way: Moussaid et al.,
"Experimental study of the behavioural mechanisms underlying self-organization in human crowds", 2009).

Masses are 1, so that forces are accelerations, m/s^2. Who moves is a row: x, y, velocity by x and y, radius.
"""

import math

import numba
import numpy as np

# Seconds in which one comes to one's own speed.
RELAXATION = 0.5
# Of Moussaid et al.: strength, weight of velocities, reach, and how narrow the push back and the push aside
# are.
STRENGTH, OF_VELOCITY, REACH, NARROW_BACK, NARROW_ASIDE = 4.5, 2.0, 0.35, 3.0, 2.0
# Of walls (Moussaid et al.), and of bodies that nearly touch (Helbing, Farkas and Vicsek, 2000): strength,
# reach, metres.
WALL_STRENGTH, WALL_REACH = 3.0, 0.1
TOUCH_STRENGTH, TOUCH_REACH = 12.0, 0.08
# Who walks together draws near its middle when farther off than this, metres, with this strength.
TOGETHER, COHESION = 0.6, 1.5
# How much faster than one likes one gets out of the way, and m/s of who rests.
HASTE, SHUFFLE = 1.3, 0.5


def advance(
    rows: np.ndarray,
    speeds: np.ndarray,
    goals: np.ndarray,
    groups: np.ndarray,
    robots: np.ndarray,
    walls: np.ndarray,
    ways: np.ndarray,
    size: float,
    seconds: float,
) -> np.ndarray:
    """Moves people on, and returns the forces on them without that to their goals, (N, 2).

    ``rows`` (N, 5): x, y, velocity by x and y, radius, changed in place; places are seen from the corner of
    the ground. ``speeds`` (N,): that each likes, m/s, 0: rests; ``goals`` (N,): which of the ``ways``
    (G, rows, cols), metres to a goal, each is on; ``groups`` (N,), 0: alone; ``robots`` (M, 5): as people.
    ``walls``: metres to what is solid; ``size``: of a cell; ``seconds``: how far to move on.
    """
    forces = _forces(rows, groups, robots, walls, size)
    _move(rows, speeds, goals, forces, walls, ways, size, seconds)
    return forces


def push(own: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The social force of others, rows (N, 5), on who moves as ``own``, (5,); (N, 2)."""
    return np.array([_social_force(own, other) for other in others]).reshape(-1, 2)


@numba.njit(cache=True)
def _forces(rows, groups, robots, walls, size):
    """Of others, of walls and of those who walk together, (N, 2)."""
    forces = np.zeros((rows.shape[0], 2))
    for i in range(rows.shape[0]):
        x, y = _wall_force(rows[i, 0], rows[i, 1], rows[i, 4], walls, size)
        together, mid_x, mid_y = 0, 0.0, 0.0
        for j in range(rows.shape[0]):
            if groups[j] == groups[i]:
                together, mid_x, mid_y = together + 1, mid_x + rows[j, 0], mid_y + rows[j, 1]
            if i != j:
                of_x, of_y = _social_force(rows[i], rows[j])
                x, y = x + of_x, y + of_y
        for j in range(robots.shape[0]):
            of_x, of_y = _social_force(rows[i], robots[j])
            x, y = x + of_x, y + of_y
        off_x, off_y = mid_x / together - rows[i, 0], mid_y / together - rows[i, 1]
        off = math.hypot(off_x, off_y)
        if groups[i] != 0 and off > TOGETHER:
            x, y = x + COHESION * off_x / off, y + COHESION * off_y / off
        forces[i] = x, y
    return forces


@numba.njit(cache=True)
def _move(rows, speeds, goals, forces, walls, ways, size, seconds):
    """Velocities, then places; nobody is faster than a little more than likes, nor walks into a wall."""
    for i in range(rows.shape[0]):
        ahead_x, ahead_y = _way_ahead(rows[i, 0], rows[i, 1], ways[goals[i]], size)
        v_x = rows[i, 2] + seconds * (forces[i, 0] + (speeds[i] * ahead_x - rows[i, 2]) / RELAXATION)
        v_y = rows[i, 3] + seconds * (forces[i, 1] + (speeds[i] * ahead_y - rows[i, 3]) / RELAXATION)
        fastest = max(HASTE * speeds[i], SHUFFLE)
        slower = min(1.0, fastest / max(math.hypot(v_x, v_y), 1e-9))
        v_x, v_y = slower * v_x, slower * v_y
        x, y = rows[i, 0] + seconds * v_x, rows[i, 1] + seconds * v_y
        here = _value_at(walls, rows[i, 0] / size, rows[i, 1] / size)
        there = _value_at(walls, x / size, y / size)
        if there < rows[i, 4] and there < here:
            x, y, v_x, v_y = rows[i, 0], rows[i, 1], 0.0, 0.0
        rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3] = x, y, v_x, v_y


@numba.njit(cache=True)
def _social_force(own, other):
    """On who moves as ``own`` because of ``other``, both rows (5,)."""
    off_x, off_y = other[0] - own[0], other[1] - own[1]
    distance = math.hypot(off_x, off_y)
    if distance < 1e-6:
        return 0.0, 0.0
    off_x, off_y = off_x / distance, off_y / distance
    toward_x = OF_VELOCITY * (own[2] - other[2]) + off_x
    toward_y = OF_VELOCITY * (own[3] - other[3]) + off_y
    length = max(math.hypot(toward_x, toward_y), 1e-6)
    toward_x, toward_y = toward_x / length, toward_y / length
    angle = math.atan2(toward_x * off_y - toward_y * off_x, toward_x * off_x + toward_y * off_y)
    reach = REACH * length
    back = STRENGTH * math.exp(-distance / reach - (NARROW_BACK * reach * angle) ** 2)
    aside = STRENGTH * math.exp(-distance / reach - (NARROW_ASIDE * reach * angle) ** 2)
    # To the right of who comes straight on.
    side = -1.0 if angle >= 0.0 else 1.0
    touch = TOUCH_STRENGTH * math.exp(min(own[4] + other[4] - distance, 0.1) / TOUCH_REACH)
    return (
        -back * toward_x - side * aside * toward_y - touch * off_x,
        -back * toward_y + side * aside * toward_x - touch * off_y,
    )


@numba.njit(cache=True)
def _wall_force(x, y, radius, walls, size):
    """Of what is solid; x, y from the corner of ``walls``, metres to it of cells with sides of ``size``."""
    near = _value_at(walls, x / size, y / size)
    # Between two walls the field rises less, as they push against each other: it is flat in the middle.
    force = 0.5 / size * WALL_STRENGTH * math.exp(min(radius - near + 0.5 * size, 0.1) / WALL_REACH)
    slope_x = _value_at(walls, x / size + 1.0, y / size) - _value_at(walls, x / size - 1.0, y / size)
    slope_y = _value_at(walls, x / size, y / size + 1.0) - _value_at(walls, x / size, y / size - 1.0)
    return force * slope_x, force * slope_y


@numba.njit(cache=True)
def _way_ahead(x, y, ways, size):
    """The direction in which a goal comes nearer, (0, 0) at it; ``ways``: metres to it from each cell."""
    rows, cols = ways.shape
    col, row = int(x / size), int(y / size)
    best, best_x, best_y = np.inf, 0.0, 0.0
    for down in range(-3, 4):
        for right in range(-3, 4):
            there_row, there_col = row + down, col + right
            if 0 <= there_row < rows and 0 <= there_col < cols:
                off_x, off_y = (there_col + 0.5) * size - x, (there_row + 0.5) * size - y
                cost = ways[there_row, there_col] + math.hypot(off_x, off_y)
                if cost < best:
                    best, best_x, best_y = cost, off_x, off_y
    length = math.hypot(best_x, best_y)
    return (best_x / length, best_y / length) if length > 1e-6 else (0.0, 0.0)


@numba.njit(cache=True)
def _value_at(field, col, row):
    """Between the middles of cells; at the edge, that of the edge."""
    rows, cols = field.shape
    col, row = min(max(col - 0.5, 0.0), cols - 1.001), min(max(row - 0.5, 0.0), rows - 1.001)
    left, low = int(col), int(row)
    right, up = col - left, row - low
    below = (1.0 - right) * field[low, left] + right * field[low, left + 1]
    above = (1.0 - right) * field[low + 1, left] + right * field[low + 1, left + 1]
    return (1.0 - up) * below + up * above
