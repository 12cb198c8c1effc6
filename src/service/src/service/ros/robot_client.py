"""The robot over ROS: navigation, docking, battery."""

import math
from typing import Optional

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from sensor_msgs.msg import BatteryState

from pick_objects import DriveToPlace, LookForObject
from pick_objects.ros.navigation_client import NavigationClient
from planar import Pose2
from planar.driving import RobotDisplaced
from planar_ros.messages.conversion import pose2_from_msg
from planar_ros.messages.validation import subscribe
from service.execution.robot import DockRobot, RobotEvent, RobotInputs, RobotOrder, StopRobot, UndockRobot
from service.ros.docking_client import DockingClient

CHARGING = (BatteryState.POWER_SUPPLY_STATUS_CHARGING, BatteryState.POWER_SUPPLY_STATUS_FULL)


class RobotClient:
    """Carries out orders, and returns what is known of the robot.

    Args:
        frame_id: Frame of the places.
        pose: Pose until the first estimate.
        detects: Whether objects are searched.

    Attributes:
        navigation: Client of move_base.
        is_moving: Whether an order is under way that moves the robot.
    """

    def __init__(self, frame_id: str, pose: Pose2, detects: bool = False):
        self.navigation = NavigationClient(frame_id, detects)
        self._docking, self._pose = DockingClient(), pose
        self._fed_back: Optional[Pose2] = None
        self._charge: Optional[float] = None
        self._is_docked = self.is_moving = False
        subscribe("amcl_pose", PoseWithCovarianceStamped, self._on_pose, queue_size=1)
        rospy.Subscriber("battery_state", BatteryState, self._on_battery, queue_size=1)

    def inputs(self) -> RobotInputs:
        """Return what is known of the robot."""
        latest = self.navigation.move_base.robot
        if latest is not None and latest is not self._fed_back:
            self._pose = self._fed_back = latest
        return RobotInputs(self._pose, self._charge, self._is_docked)

    def event(self, now: float) -> Optional[RobotEvent]:
        """Return what happened to the last order, if there is news; ``now`` is ROS time [s]."""
        event = self._docking.event(now) or self.navigation.driver.event(now)
        if event is not None and not isinstance(event, RobotDisplaced):
            self.is_moving = False
        return event

    def carry_out(self, order: Optional[RobotOrder], now: float) -> None:
        """Begin an order, which replaces any earlier one."""
        if order is None:
            return
        self.is_moving = not isinstance(order, StopRobot)
        self._docking.cancel()
        if isinstance(order, (DriveToPlace, LookForObject)):
            self.navigation.driver.carry_out(order)
            return
        self.navigation.driver.discard_order()
        self.navigation.move_base.cancel()
        if isinstance(order, DockRobot):
            self._docking.dock(now)
        elif isinstance(order, UndockRobot):
            self._docking.undock(now)
        else:
            assert isinstance(order, StopRobot)

    def _on_pose(self, message: PoseWithCovarianceStamped) -> None:
        self._pose = pose2_from_msg(message.pose.pose)

    def _on_battery(self, message: BatteryState) -> None:
        charge = float(message.percentage)
        self._charge = min(1.0, max(0.0, charge)) if math.isfinite(charge) and message.present else None
        self._is_docked = message.power_supply_status in CHARGING
