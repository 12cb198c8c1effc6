"""Turtles move and draw as turtlesim's do."""

import io
import math

import numpy as np
import pytest
from PIL import Image

from planar import PlanarError
from turtle_world import Pen, TurtleError, TurtleVelocity, TurtleWorld
from turtle_world.canvas import BACKGROUND, FLOOR_SIDE, PIXELS_PER_METRE, Canvas
from turtle_world.physics import PERIOD

MIDDLE = 0.5 * FLOOR_SIDE


def run(world, steps, name="turtle1", command=None):
    """Step with the command repeated; returns the last state."""
    for _ in range(steps):
        if command is not None:
            world.command(name, command)
        state = world.step()[name]
    return state


def distance_from(points, x, y):
    """Metres from a polyline."""
    starts, ends = np.array(points[:-1]), np.array(points[1:])
    along = ends - starts
    share = ((np.array((x, y)) - starts) * along).sum(1) / (along**2).sum(1)
    nearest = starts + np.clip(share, 0.0, 1.0)[:, None] * along
    return np.hypot(*(nearest - (x, y)).T).min()


def turtlesim(steps, command, x=MIDDLE, y=MIDDLE, theta=0.0):
    """turtlesim's own formulas."""
    for _ in range(steps):
        theta += command.turn * PERIOD
        x += (math.cos(theta) * command.forward - math.sin(theta) * command.leftward) * PERIOD
        y += (math.sin(theta) * command.forward + math.cos(theta) * command.leftward) * PERIOD
    return x, y, math.remainder(theta, 2.0 * math.pi)


def test_a_turtle_starts_in_the_middle():
    world = TurtleWorld()
    assert world.names == ["turtle1"]
    assert world.step()["turtle1"].pose == pytest.approx((MIDDLE, MIDDLE, 0.0))
    assert abs(FLOOR_SIDE - 11.088889) < 1e-6


@pytest.mark.parametrize(
    "command", [TurtleVelocity(2.0, 0.0, 1.8), TurtleVelocity(-1.0, 0.5, -0.7), TurtleVelocity(0.0, 0.0, 2.0)]
)
def test_a_turtle_moves_as_turtlesims_does(command):
    state = run(TurtleWorld(), 120, command=command)
    x, y, theta = turtlesim(120, command)
    assert state.pose[:2] == pytest.approx((x, y), abs=1e-4)
    assert math.remainder(state.pose.theta - theta, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-4)
    assert state.speed == pytest.approx(math.hypot(command.forward, command.leftward))


def test_a_command_times_out_after_a_second():
    world = TurtleWorld()
    world.command("turtle1", TurtleVelocity(1.0))
    state = run(world, 200)
    assert state.pose.x - MIDDLE == pytest.approx(1.0, abs=PERIOD) and state.speed == 0.0


@pytest.mark.parametrize("theta, edge", [(0.0, (FLOOR_SIDE, MIDDLE)), (-math.pi / 2, (MIDDLE, 0.0))])
def test_a_wall_stops_a_turtle_at_the_edge_and_its_target_is_reported(theta, edge):
    world = TurtleWorld()
    world.teleport("turtle1", MIDDLE, MIDDLE, theta)
    state = run(world, 300, command=TurtleVelocity(2.0))
    assert state.pose[:2] == pytest.approx(edge, abs=0.01)
    assert 0.0 <= state.pose.x <= FLOOR_SIDE and 0.0 <= state.pose.y <= FLOOR_SIDE
    assert not (0.0 <= state.blocked_target[0] <= FLOOR_SIDE and 0.0 <= state.blocked_target[1] <= FLOOR_SIDE)


def test_a_turtle_slides_along_a_wall():
    world = TurtleWorld()
    world.teleport("turtle1", FLOOR_SIDE - 0.2, 2.0, math.pi / 4)
    state = run(world, 100, command=TurtleVelocity(2.0))
    assert state.pose.x == pytest.approx(FLOOR_SIDE, abs=0.01)
    assert state.pose.y == pytest.approx(2.0 + 100 * PERIOD * 2.0 * math.sin(math.pi / 4), abs=0.05)


def test_turtles_pass_through_each_other():
    world = TurtleWorld()
    world.spawn("other", MIDDLE + 1.0, MIDDLE, 0.0)
    assert run(world, 100, command=TurtleVelocity(2.0)).pose.x == pytest.approx(MIDDLE + 3.2, abs=0.01)
    assert world.pose_of("other").x == pytest.approx(MIDDLE + 1.0)


def test_names_are_generated_and_unique():
    world = TurtleWorld()
    assert world.spawn("", 1.0, 2.0, 0.5) == "turtle2"
    assert world.pose_of("turtle2") == pytest.approx((1.0, 2.0, 0.5))
    with pytest.raises(TurtleError, match="already exists"):
        world.spawn("turtle2", 1.0, 1.0, 0.0)
    assert world.names == ["turtle1", "turtle2"]


@pytest.mark.parametrize(
    "command",
    [
        lambda world: world.kill("nobody"),
        lambda world: world.command("nobody", TurtleVelocity()),
        lambda world: world.set_pen("nobody", Pen()),
        lambda world: world.teleport("nobody", 1.0, 1.0, 0.0),
    ],
)
def test_an_unknown_turtle_is_an_error(command):
    with pytest.raises(TurtleError, match="nobody"):
        command(TurtleWorld())


def test_velocities_that_are_not_finite_are_rejected_and_change_nothing():
    world = TurtleWorld()
    for value in (math.nan, math.inf):
        with pytest.raises(TurtleError, match="finite"):
            world.command("turtle1", TurtleVelocity(value))
    assert world.step()["turtle1"].pose == pytest.approx((MIDDLE, MIDDLE, 0.0))


def test_a_turtle_spawned_beyond_the_edge_stands_on_it():
    world = TurtleWorld()
    world.spawn("far", 30.0, -2.0, 0.0)
    assert world.pose_of("far")[:2] == pytest.approx((FLOOR_SIDE, 0.0))


def test_teleporting_draws_a_line_and_the_turtle_sees_its_colour():
    world = TurtleWorld()
    assert world.step()["turtle1"].color == BACKGROUND
    world.set_pen("turtle1", Pen((200, 10, 20), 5))
    world.teleport_by("turtle1", 2.0, math.pi / 2)
    assert world.pose_of("turtle1") == pytest.approx((MIDDLE, MIDDLE + 2.0, math.pi / 2))
    assert world.step()["turtle1"].color == (200, 10, 20)
    assert world.canvas.color_at(MIDDLE, MIDDLE + 1.0) == (200, 10, 20)


def test_a_lifted_pen_draws_nothing():
    world = TurtleWorld()
    world.set_pen("turtle1", Pen(is_on=False))
    run(world, 50, command=TurtleVelocity(2.0))
    assert world.canvas.strokes == []


def test_a_path_is_one_stroke_until_the_pen_changes():
    world = TurtleWorld()
    run(world, 50, command=TurtleVelocity(1.0, 0.0, 1.0))
    world.set_pen("turtle1", Pen((1, 2, 3)))
    run(world, 50, command=TurtleVelocity(1.0, 0.0, 1.0))
    first, second = world.canvas.strokes
    assert first.points[0] == (MIDDLE, MIDDLE) and second.pen.color == (1, 2, 3)
    assert second.points[0] == first.points[-1]


def test_a_straight_path_has_two_points_and_one_more_for_each_reversal():
    world = TurtleWorld()
    for speed in (1.0, -1.0, 1.0):
        run(world, 50, command=TurtleVelocity(speed))
    (stroke,) = world.canvas.strokes
    assert len(stroke.points) == 4
    assert max(x for x, _ in stroke.points) == pytest.approx(MIDDLE + 50 * PERIOD, abs=2 * PERIOD)


def test_a_circle_keeps_its_shape_by_a_pixel_with_a_quarter_of_its_steps():
    world, truth = TurtleWorld(), [(MIDDLE, MIDDLE)]
    for _ in range(400):
        truth.append(tuple(run(world, 1, command=TurtleVelocity(2.0, 0.0, 2.0)).pose[:2]))
    (stroke,) = world.canvas.strokes
    assert len(stroke.points) < len(truth) / 4
    assert max(distance_from(stroke.points, *point) for point in truth) < 1.0 / PIXELS_PER_METRE


def test_a_long_drawing_is_limited_to_its_latest_points():
    canvas = Canvas()
    for x in range(10):
        canvas.draw("turtle1", Pen(width=1 + x // 5), (x, x % 2), (x + 1.0, 1.0 - x % 2))
    old, new = canvas.latest_strokes(9)
    assert new == canvas.strokes[-1] and old.points == canvas.strokes[0].points[-3:]
    assert canvas.latest_strokes(100) == canvas.strokes and canvas.latest_strokes(6) == [new]


def test_killing_keeps_the_drawing_and_a_reset_leaves_one_turtle_on_an_empty_floor():
    world = TurtleWorld()
    world.spawn("artist", 1.0, 1.0, 0.0)
    world.teleport("artist", 3.0, 1.0, 0.0)
    world.kill("artist")
    assert world.names == ["turtle1"] and len(world.canvas.strokes) == 1
    run(world, 20, command=TurtleVelocity(1.0))
    world.reset((9, 9, 9))
    assert world.names == ["turtle1"] and world.canvas.strokes == []
    assert world.step()["turtle1"].pose == pytest.approx((MIDDLE, MIDDLE, 0.0))
    assert world.step()["turtle1"].color == (9, 9, 9)


def test_the_picture_shows_floor_trail_and_turtle():
    world = TurtleWorld()
    world.set_pen("turtle1", Pen((250, 0, 0), 4))
    world.teleport("turtle1", 9.0, MIDDLE, 0.0)
    picture = Image.open(io.BytesIO(world.picture()))
    assert picture.size == (500, 500)
    colors = {color for _, color in picture.getcolors(100)}
    assert BACKGROUND in colors and (250, 0, 0) in colors and len(colors) >= 4


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300])
def test_a_pose_that_is_not_finite_is_rejected(value):
    """Regression: a pose with NaN ended the thread that steps the world."""
    world = TurtleWorld()
    for set_pose in (
        lambda: world.teleport("turtle1", value, 1.0, 0.0),
        lambda: world.teleport("turtle1", 1.0, 1.0, value),
        lambda: world.teleport_by("turtle1", value, 0.0),
        lambda: world.teleport_by("turtle1", 0.0, value),
        lambda: world.spawn("", 1.0, value, 0.0),
    ):
        with pytest.raises(PlanarError, match="with invalid"):
            set_pose()
    assert world.names == ["turtle1"]
    world.step()
