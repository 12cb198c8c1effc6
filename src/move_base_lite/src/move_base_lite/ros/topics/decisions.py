"""Topics for the Navigator's decisions."""

from typing import Optional

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist
from move_base_msgs.msg import RecoveryStatus
from nav_msgs.msg import Path

from move_base_lite.navigator.decision import Decision, GoalOutcome, RecoveryStart
from move_base_lite.ros.topics.dwa_clouds import DwaCloudTopics
from move_base_lite.ros.topics.plan_messages import path_msg, plan_msg, pose_msg, trajectory_msg
from move_base_lite.ros.topics.status_messages import outcome_msg, progress_msg
from planar import Pose2, Twist2
from planar_ros.node.topics import flush_and_close

FEEDBACK_PERIOD = rospy.Duration(0.2)
# Namespace in which rviz configurations expect the plans of any other local planner.
DEFAULT_LOCAL_PLANNER = "DWAPlannerROS"
OFFICIAL_LOCAL_PLANNERS = (DEFAULT_LOCAL_PLANNER, "TrajectoryPlannerROS")


class DecisionTopics:
    """Publishes velocity commands, plans, recovery behaviours, progress and outcome."""

    def __init__(self, global_planner: str, local_planner: str, map_frame: str, odom_frame: str):
        """Advertise the topics.

        Args:
            global_planner: Name of the global planner, the namespace of its plan.
            local_planner: Name of the local planner, the namespace of its plans.
            map_frame: Frame of global plans.
            odom_frame: Frame of local plans.
        """
        self._map_frame, self._odom_frame = map_frame, odom_frame
        self._next_feedback = rospy.Time(0)
        local = local_planner if local_planner in OFFICIAL_LOCAL_PLANNERS else DEFAULT_LOCAL_PLANNER
        self._command = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        self._outcome = rospy.Publisher("~outcome", DiagnosticStatus, queue_size=1, latch=True)
        self._feedback = rospy.Publisher("~nav_feedback", DiagnosticStatus, queue_size=1)
        self._recovery = rospy.Publisher("move_base/recovery_status", RecoveryStatus, queue_size=1)
        self._plan = rospy.Publisher(f"~{global_planner}/plan", Path, queue_size=1)
        self._global_plan = rospy.Publisher(f"~{local}/global_plan", Path, queue_size=1)
        self._local_plan = rospy.Publisher(f"~{local}/local_plan", Path, queue_size=1)
        self._dwa_clouds = DwaCloudTopics(local, odom_frame)

    def publish_command(self, command: Twist2) -> None:
        """Publish a velocity command."""
        message = Twist()
        message.linear.x, message.angular.z = command.v, command.omega
        self._command.publish(message)

    def publish_final_stop(self) -> None:
        """Publish a stop command, and wait until it is sent to the subscribers."""
        self.publish_command(Twist2())
        flush_and_close(self._command)

    def publish_end(self, decision: Decision) -> None:
        """Publish the last command for a goal, and its outcome."""
        if decision.command is not None:
            self.publish_command(decision.command)
        if decision.outcome is not None:
            self.publish_outcome(decision.outcome)

    def publish_outcome(self, outcome: GoalOutcome) -> None:
        """Publish the outcome of a goal."""
        self._outcome.publish(outcome_msg(outcome))

    def reset_time(self) -> None:
        """Publish progress at the next tick, since time has jumped back."""
        self._next_feedback = rospy.Time(0)

    def publish(
        self, now: rospy.Time, decision: Decision, base_in_map: Pose2, goal: Pose2, orientation_mode: int
    ) -> None:
        """Publish everything of a decision except the action's result.

        Args:
            now: Stamp of the messages.
            decision: Decision of the Navigator.
            base_in_map: Robot pose in the map frame.
            goal: Goal pose in the map frame.
            orientation_mode: Mode of the headings along the plan (see headings_along).
        """
        self.publish_end(decision)
        if decision.plan_xy is not None and self._plan.get_num_connections():
            plan = plan_msg(
                decision.plan_xy, now, self._map_frame, orientation_mode, base_in_map.yaw, goal.yaw
            )
            self._plan.publish(plan)
        self._publish_followed(now, decision.followed_xy)
        if decision.trajectory is not None and self._local_plan.get_num_connections():
            self._local_plan.publish(trajectory_msg(decision.trajectory, now, self._odom_frame))
        if decision.trajectory_samples is not None:
            self._dwa_clouds.publish(now, decision.trajectory_samples)
        if decision.recovery is not None:
            self._publish_recovery(now, decision.recovery, base_in_map)
        if decision.progress is not None and now >= self._next_feedback:
            self._next_feedback = now + FEEDBACK_PERIOD
            self._feedback.publish(progress_msg(decision, decision.progress))

    def _publish_followed(self, now: rospy.Time, path_xy: Optional[np.ndarray]):
        if path_xy is not None and self._global_plan.get_num_connections():
            yaws = np.zeros(len(path_xy))
            self._global_plan.publish(path_msg(path_xy, now, self._odom_frame, yaws))

    def _publish_recovery(self, now: rospy.Time, recovery: RecoveryStart, base_in_map: Pose2):
        rospy.logwarn("recovery behavior %s (%d of %d)", recovery.name, recovery.index + 1, recovery.total)
        pose = pose_msg(base_in_map, now, self._map_frame)
        self._recovery.publish(RecoveryStatus(pose, recovery.index, recovery.total, recovery.name))
