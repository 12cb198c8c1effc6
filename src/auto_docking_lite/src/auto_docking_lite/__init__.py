"""Docking of a Kobuki on its charging station, without ROS; the node is in ``auto_docking_lite.ros.node``.

The facade is ``DockController``. Time and inputs are arguments; one call per control tick::

    controller = DockController(DockingSettings(), navigation)   # navigation: see StagingPort; None: none
    controller.start(now, dock_in_map)                           # dock_in_map: Pose2 of the dock, or None
    while controller.is_active:
        decision = controller.tick(DockInputs(now, base_in_odom, ...))
        # decision.command: Twist2 to send, or None while navigation drives the robot to the staging pose.
        # decision.state, decision.text: as the feedback of kobuki_auto_docking.
        # decision.result: DockResult once, at the end: code (DockCode), text, is_success.
    controller.cancel(now)      # ends the task at the next tick, code CANCELLED, with a zero command
    controller.undock(now)      # the same cycle; ends when the robot is clear of the dock

``DockCode`` has the numbers of Nav2's docking server (opennav_docking_msgs).

The pose of a dock is that of its front on the floor; its x axis points away from the dock, to where the robot
comes from. ``pose_when_docked(dock)`` and ``staging_pose(dock, settings)`` are the poses of the robot's base.
"""

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import (
    DockCode,
    DockDecision,
    DockInputs,
    DockResult,
    DockState,
    StagingPort,
)
from auto_docking_lite.controller import DockController
from auto_docking_lite.poses import pose_when_docked, staging_pose

__all__ = [
    "DockCode",
    "DockController",
    "DockDecision",
    "DockInputs",
    "DockResult",
    "DockState",
    "DockingSettings",
    "StagingPort",
    "pose_when_docked",
    "staging_pose",
]
