"""Cameras, inertial sensors and bumpers."""

import math

import numpy as np
import pytest

from planar import SettingsError
from sim_bridge import ROBOTS, Simulation, SimulationSettings
from sim_bridge.geometry.pose3 import pose3, transform_points
from sim_bridge.geometry.shapes import Box, Cylinder, MeshFile, Plane, Sphere
from sim_bridge.noise import noise_named
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.sensors.camera import (
    Camera,
    CameraProfile,
    CameraSettings,
    DepthCameraSettings,
    depth_to_points,
)
from sim_bridge.sensors.imu import Imu, ImuProfile, ImuSettings
from sim_bridge.sensors.kobuki import CENTRE, LEFT, RIGHT, pressed
from sim_bridge.views.render_geometry import RenderGeometry
from sim_bridge.world import Body, Collision, Visual, World

SMALL = CameraSettings(width=160, height=120)
KINECT = DepthCameraSettings()
AT_BASE = ImuProfile("imu", "base_link", np.eye(4))
EXACT = SimulationSettings(**noise_named("ideal"))


def drawing_of(*shapes):
    """Shapes with their poses and colours, drawn."""
    drawing = RenderGeometry()
    for number, (shape, pose, colour) in enumerate(shapes):
        drawing.add(Body(f"m{number}::l", pose, (), visuals=(Visual(shape, np.eye(4), colour),)))
    return drawing.triangles(lambda name: np.eye(4))


def camera(settings, seed=0):
    profile = CameraProfile("optical", np.eye(4), settings, 10.0, "image_raw", "camera_info")
    return Camera(settings, np.random.default_rng(seed), profile)


def render(settings, *shapes, at=None, seed=0):
    return camera(settings, seed).render(*drawing_of(*shapes), pose3(z=1.0) if at is None else at)


WALL = (Box((0.2, 10.0, 10.0)), pose3(3.1), (1.0, 0.0, 0.0))
FLOOR = (Plane(), np.eye(4), (0.5, 0.5, 0.5))


def test_a_wall_ahead_is_as_deep_everywhere_as_it_is_far():
    seen = render(SMALL, WALL)
    assert seen.depth == pytest.approx(np.full((120, 160), 3.0), abs=1e-5)
    assert (seen.rgb[..., 0] > 100).all()
    assert (seen.rgb[..., 1:] == 0).all()


def test_what_glows_is_as_bright_from_all_sides():
    drawing = RenderGeometry()
    ball = Visual(Sphere(0.5), np.eye(4), (1.0, 1.0, 1.0), emissive=(1.0, 1.0, 1.0))
    drawing.add(Body("ball::link", pose3(3.0, 0.0, 1.0), (), visuals=(ball,)))
    seen = camera(SMALL).render(*drawing.triangles(lambda name: np.eye(4)), pose3(z=1.0))
    assert (seen.rgb[np.isfinite(seen.depth)] == 255).all()


def test_the_floor_is_seen_where_geometry_predicts():
    seen = render(SMALL, FLOOR)
    _, centre_y = SMALL.centre
    rows = np.arange(120)
    expected = SMALL.focal_length * 1.0 / (rows[70:] - centre_y)
    assert seen.depth[70:, 80] == pytest.approx(expected, rel=1e-5)
    assert np.isinf(seen.depth[:55]).all(), "above the horizon there is nothing"


def test_what_is_nearer_hides_what_is_behind():
    seen = render(SMALL, WALL, (Sphere(0.5), pose3(2.0, 0.0, 1.0), (0.0, 0.0, 1.0)))
    assert seen.depth[60, 80] == pytest.approx(1.5, abs=0.01)
    assert seen.rgb[60, 80, 2] > 0
    assert seen.depth[5, 5] == pytest.approx(3.0, abs=1e-5)


def test_left_is_left_and_up_is_up():
    seen = render(SMALL, (Box((0.2, 0.2, 0.2)), pose3(3.0, 1.0, 1.5), (0.0, 1.0, 0.0)))
    rows, columns = np.nonzero(np.isfinite(seen.depth))
    assert columns.max() < 80
    assert rows.max() < 60


def test_points_lie_on_what_is_seen():
    at = pose3(0.3, -0.2, 0.8, 0.05, 0.2, 0.4)
    seen = render(SMALL, (Cylinder(0.6, 2.0), pose3(2.5, 1.0, 1.0), (1.0, 1.0, 1.0)), at=at)
    points = depth_to_points(seen.depth, SMALL)[np.isfinite(seen.depth)]
    camera = np.column_stack((points[:, 2], -points[:, 0], -points[:, 1]))
    in_world = transform_points(at, camera)
    distances = np.hypot(in_world[:, 0] - 2.5, in_world[:, 1] - 1.0)
    on_side = in_world[:, 2] < 1.999
    assert len(points) > 500
    assert np.abs(distances[on_side] - 0.6).max() < 0.6 * (1.0 - math.cos(math.pi / 24)) + 1e-4, "24 corners"


def test_depths_out_of_reach_are_not_numbers():
    near = (Box((0.1, 4.0, 4.0)), pose3(0.35, 0.0, 1.0), None)
    assert np.isnan(render(KINECT, near).depth).all()
    assert np.isnan(render(KINECT, (Box((0.1, 90.0, 90.0)), pose3(6.0), None)).depth).all()
    assert np.isfinite(render(KINECT, WALL).depth).all()


def test_depth_noise_grows_with_the_square_of_the_depth_and_follows_the_seed():
    noisy = DepthCameraSettings(depth_noise=0.002)
    errors = render(noisy, WALL).depth - 3.0
    assert errors.std() == pytest.approx(0.002 * 9.0, rel=0.02)
    assert np.array_equal(render(noisy, WALL, seed=1).depth, render(noisy, WALL, seed=1).depth)
    assert not np.array_equal(render(noisy, WALL, seed=1).depth, render(noisy, WALL, seed=2).depth)


def test_bodies_that_move_are_drawn_where_they_are_and_the_robot_itself_is_left_out():
    drawing = RenderGeometry()
    part = Collision(Box((0.5, 0.5, 0.5)), np.eye(4))
    drawing.add(Body("ball::l", np.eye(4), (part,), mass=1.0))
    drawing.add(Body("robot::base", np.eye(4), (part,), mass=1.0))
    triangles, shades = drawing.triangles(lambda name: pose3(5.0), excluded_model="robot")
    assert len(triangles) == len(shades) == 12
    assert triangles[..., 0].mean() == pytest.approx(5.0)
    drawing.remove("ball::l")
    assert len(drawing.triangles(lambda name: pose3(), excluded_model="robot")[0]) == 0


def test_a_mesh_that_cannot_be_read_is_named_and_the_rest_is_drawn(tmp_path):
    (tmp_path / "broken.obj").write_text("")
    drawing = RenderGeometry()
    looks = (MeshFile(tmp_path / "broken.obj"), Box((1.0, 1.0, 1.0)))
    drawing.add(Body("m::l", np.eye(4), (), visuals=tuple(Visual(look, np.eye(4)) for look in looks)))
    assert len(drawing.triangles(lambda name: np.eye(4))[0]) == 12
    assert "broken.obj" in drawing.warnings[0]


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"width": 0}, "width"),
        ({"horizontal_fov": 4.0}, "horizontal_fov"),
        ({"near": 0.0}, "near"),
        ({"near": 200.0}, "near"),
        ({"noise": -1.0}, "noise"),
    ],
)
def test_senseless_cameras_are_refused(values, named):
    with pytest.raises(SettingsError, match=f"^{named} must be"):
        CameraSettings(**values)


def at_rest(pose):
    return KinematicState(pose, np.zeros(3), np.zeros(3))


def test_an_imu_at_rest_measures_plus_g_upwards():
    imu = Imu(ImuSettings(), np.random.default_rng(0), AT_BASE)
    reading = imu.read(at_rest(pose3(pitch=0.1)), 0.02, 9.8)
    assert reading.acceleration == pytest.approx([-9.8 * math.sin(0.1), 0.0, 9.8 * math.cos(0.1)])
    assert reading.angular_velocity == pytest.approx(np.zeros(3))


def test_an_imu_measures_turning_and_accelerating_in_its_frame():
    imu = Imu(ImuSettings(), np.random.default_rng(0), AT_BASE)
    turned = pose3(yaw=math.pi / 2.0)
    imu.read(KinematicState(turned, np.zeros(3), np.zeros(3)), 0.1, 9.8)
    reading = imu.read(KinematicState(turned, np.array([0.0, 0.2, 0.0]), np.array([0.0, 0.0, 0.7])), 0.1, 9.8)
    assert reading.acceleration == pytest.approx([2.0, 0.0, 9.8])
    assert reading.angular_velocity == pytest.approx([0.0, 0.0, 0.7])


def test_imu_noise_has_the_deviation_asked_for():
    def readings(seed):
        imu = Imu(ImuSettings(gyro_noise=0.01, acceleration_noise=0.1), np.random.default_rng(seed), AT_BASE)
        return [imu.read(at_rest(np.eye(4)), 0.02, 9.8) for _ in range(2000)]

    assert np.std([reading.angular_velocity for reading in readings(0)]) == pytest.approx(0.01, rel=0.05)
    accelerations = [reading.acceleration - (0.0, 0.0, 9.8) for reading in readings(0)]
    assert np.std(accelerations) == pytest.approx(0.1, rel=0.05)
    assert np.array_equal(readings(3)[0].angular_velocity, readings(3)[0].angular_velocity)


@pytest.mark.parametrize(
    ("bearing", "height", "expected"),
    [
        (0.0, 0.05, {CENTRE}),
        (60.0, 0.05, {LEFT}),
        (-60.0, 0.05, {RIGHT}),
        (30.0, 0.05, {LEFT, CENTRE}),
        (120.0, 0.05, set()),
        (0.0, 0.2, set()),
        (0.0, 0.005, set()),
    ],
)
def test_the_pressed_sectors_are_those_with_contacts(bearing, height, expected):
    angle = math.radians(bearing)
    assert pressed(np.array([[0.178 * math.cos(angle), 0.178 * math.sin(angle), height]])) == expected


def test_a_bumper_without_contacts_is_not_pressed():
    assert pressed(np.empty((0, 3))) == frozenset()


def test_the_depth_camera_and_the_laser_made_of_it_agree():
    room = World("room", (Body("floor::l", np.eye(4), (Collision(Plane(), np.eye(4)),)), *_furniture()))
    robot = ROBOTS["turtlebot_kinect"]
    simulation = Simulation(room, robot, EXACT)
    scan = next(filter(None, (simulation.step().scan for _ in range(20))))
    laser = simulation.scene.models.state("mobile_base").pose @ robot.laser.pose_in_base
    settings = DepthCameraSettings(min_depth=robot.laser.range_min, max_depth=robot.laser.sight)
    seen = camera(settings).render(*simulation.scene.view.triangles("mobile_base"), laser)
    middle = depth_to_points(seen.depth, settings)[240]
    bearings, ranges = np.arctan2(-middle[:, 0], middle[:, 2]), np.hypot(middle[:, 0], middle[:, 2])
    at_bearings = np.interp(bearings[::-1], scan.angles, scan.ranges)[::-1]
    errors = np.abs(ranges - at_bearings)
    print(f"depth camera against laser: median {np.nanmedian(errors):.4f} m")
    assert np.nanmedian(errors) < 0.002
    assert (errors[np.isfinite(errors)] < 0.02).mean() > 0.95, "all but the edges of objects"
    simulation.close()


def _furniture():
    for number, (x, y, yaw) in enumerate([(2.0, 0.3, 0.4), (3.0, -0.8, 0.0), (4.2, 1.0, 1.0)]):
        yield Body(
            f"box_{number}::l", pose3(x, y, 0.5, yaw=yaw), (Collision(Box((0.6, 0.8, 1.0)), np.eye(4)),)
        )
    yield Body("wall::l", pose3(4.6, 0.0, 1.0), (Collision(Box((0.1, 9.0, 2.0)), np.eye(4)),))
