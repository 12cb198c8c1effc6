"""Social force model of pedestrians (Helbing and Molnar, 1995).

The interaction force is that of Moussaid et al., "Experimental study of the behavioural mechanisms underlying
self-organization in human crowds", 2009. Masses are 1, so that forces are accelerations [m/s^2]. The state of
an agent is a row: x, y [m], velocity along x and y [m/s], radius [m].
"""

import math

import numba
import numpy as np

# Time constant with which an agent reaches its preferred velocity [s].
RELAXATION = 0.5
# Interaction force of Moussaid et al.: A, lambda, gamma, n' (deceleration) and n (change of direction).
STRENGTH, VELOCITY_WEIGHT, RANGE, DECELERATION_NARROWNESS, DIRECTION_NARROWNESS = 4.5, 2.0, 0.35, 3.0, 2.0
# Strength and range [m] of the forces of walls (Moussaid et al.) and of bodies in contact (Helbing, Farkas
# and Vicsek, 2000).
WALL_STRENGTH, WALL_RANGE = 3.0, 0.1
CONTACT_STRENGTH, CONTACT_RANGE = 12.0, 0.08
# Distance from the group's centroid above which cohesion acts [m], and its strength.
GROUP_DISTANCE, COHESION = 0.6, 1.5
# Ratio of the largest to the preferred speed, and largest speed of an agent at rest [m/s].
MAX_SPEED_RATIO, MAX_REST_SPEED = 1.3, 0.5


def social_forces(own: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return the social forces of other agents on one agent.

    Args:
        own: State (5,) of the agent.
        others: States (N, 5) of the others.

    Returns:
        A force (N, 2) for each of the others [m/s^2].
    """
    return np.array([_social_force(own, other) for other in others]).reshape(-1, 2)


@numba.njit(cache=True)
def forces_on(rows, groups, robots, walls, size):
    """Return the forces (N, 2) of other agents, of walls and of the own group [m/s^2].

    Args:
        rows: States (N, 5); positions are relative to the corner of the grid.
        groups: Numbers (N,) of the agents' groups; 0 for none.
        robots: States (M, 5) of robots.
        walls: Distance (rows, cols) of each cell to the nearest solid [m].
        size: Size of a cell [m].
    """
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
        if groups[i] != 0 and off > GROUP_DISTANCE:
            x, y = x + COHESION * off_x / off, y + COHESION * off_y / off
        forces[i] = x, y
    return forces


@numba.njit(cache=True)
def move(rows, speeds, goals, forces, walls, goal_distances, size, seconds):
    """Update velocities, then positions; limits the speed and prevents agents from entering walls.

    Args:
        rows: States (N, 5), changed in place; positions are relative to the corner of the grid.
        speeds: Preferred speeds (N,) [m/s]; 0 for an agent at rest.
        goals: Indices (N,) of the agents' goals in ``goal_distances``.
        forces: Forces (N, 2) on the agents, without those towards their goals [m/s^2].
        walls: Distance (rows, cols) of each cell to the nearest solid [m].
        goal_distances: Path length (G, rows, cols) from each cell to each goal [m].
        size: Size of a cell [m].
        seconds: Time step [s].
    """
    for i in range(rows.shape[0]):
        ahead_x, ahead_y = _goal_direction(rows[i, 0], rows[i, 1], goal_distances[goals[i]], size)
        v_x = rows[i, 2] + seconds * (forces[i, 0] + (speeds[i] * ahead_x - rows[i, 2]) / RELAXATION)
        v_y = rows[i, 3] + seconds * (forces[i, 1] + (speeds[i] * ahead_y - rows[i, 3]) / RELAXATION)
        fastest = max(MAX_SPEED_RATIO * speeds[i], MAX_REST_SPEED)
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
    """Return the force of one agent on another, both states (5,)."""
    off_x, off_y = other[0] - own[0], other[1] - own[1]
    distance = math.hypot(off_x, off_y)
    if distance < 1e-6:
        return 0.0, 0.0
    off_x, off_y = off_x / distance, off_y / distance
    toward_x = VELOCITY_WEIGHT * (own[2] - other[2]) + off_x
    toward_y = VELOCITY_WEIGHT * (own[3] - other[3]) + off_y
    length = max(math.hypot(toward_x, toward_y), 1e-6)
    toward_x, toward_y = toward_x / length, toward_y / length
    angle = math.atan2(toward_x * off_y - toward_y * off_x, toward_x * off_x + toward_y * off_y)
    reach = RANGE * length
    back = STRENGTH * math.exp(-distance / reach - (DECELERATION_NARROWNESS * reach * angle) ** 2)
    aside = STRENGTH * math.exp(-distance / reach - (DIRECTION_NARROWNESS * reach * angle) ** 2)
    # An agent that comes straight on is passed on its right.
    side = -1.0 if angle >= 0.0 else 1.0
    touch = CONTACT_STRENGTH * math.exp(min(own[4] + other[4] - distance, 0.1) / CONTACT_RANGE)
    return (
        -back * toward_x - side * aside * toward_y - touch * off_x,
        -back * toward_y + side * aside * toward_x - touch * off_y,
    )


@numba.njit(cache=True)
def _wall_force(x, y, radius, walls, size):
    """Return the force of walls at a position relative to the corner of the grid ``walls``."""
    near = _value_at(walls, x / size, y / size)
    # The force is proportional to the gradient of the distance, which vanishes midway between two walls.
    force = 0.5 / size * WALL_STRENGTH * math.exp(min(radius - near + 0.5 * size, 0.1) / WALL_RANGE)
    slope_x = _value_at(walls, x / size + 1.0, y / size) - _value_at(walls, x / size - 1.0, y / size)
    slope_y = _value_at(walls, x / size, y / size + 1.0) - _value_at(walls, x / size, y / size - 1.0)
    return force * slope_x, force * slope_y


@numba.njit(cache=True)
def _goal_direction(x, y, distances, size):
    """Return the direction in which the path length ``distances`` to a goal decreases; (0, 0) at the goal."""
    rows, cols = distances.shape
    col, row = int(x / size), int(y / size)
    best, best_x, best_y = np.inf, 0.0, 0.0
    for down in range(-3, 4):
        for right in range(-3, 4):
            there_row, there_col = row + down, col + right
            if 0 <= there_row < rows and 0 <= there_col < cols:
                off_x, off_y = (there_col + 0.5) * size - x, (there_row + 0.5) * size - y
                cost = distances[there_row, there_col] + math.hypot(off_x, off_y)
                if cost < best:
                    best, best_x, best_y = cost, off_x, off_y
    length = math.hypot(best_x, best_y)
    return (best_x / length, best_y / length) if length > 1e-6 else (0.0, 0.0)


@numba.njit(cache=True)
def _value_at(field, col, row):
    """Interpolate a field bilinearly between the centres of cells; it is constant beyond its edges."""
    rows, cols = field.shape
    col, row = min(max(col - 0.5, 0.0), cols - 1.001), min(max(row - 0.5, 0.0), rows - 1.001)
    left, low = int(col), int(row)
    right, up = col - left, row - low
    below = (1.0 - right) * field[low, left] + right * field[low, left + 1]
    above = (1.0 - right) * field[low + 1, left] + right * field[low + 1, left + 1]
    return (1.0 - up) * below + up * above
