"""The node ``move_base``: a Navigator behind move_base's action, topics and services."""

import threading
from typing import Optional

import numpy as np
import rospy
from actionlib import SimpleActionServer
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionGoal, MoveBaseFeedback, RecoveryStatus
from nav_msgs.msg import Path
from nav_msgs.srv import GetPlan, GetPlanResponse
from std_srvs.srv import Empty, EmptyResponse

from move_base_lite.decision import CANCELLED_OUTCOME, Decision, Outcome, Status, Trigger, with_reason
from move_base_lite.errors import NavigationError, RobotLost
from move_base_lite.navigator import Navigator
from move_base_lite.nodes.costmap_topics import CostmapTopics
from move_base_lite.nodes.goals import InvalidGoal, goal_from_msg
from move_base_lite.nodes.plan_messages import path_msg, pose_msg, trajectory_msg
from move_base_lite.nodes.status_messages import outcome_msg, progress_msg
from move_base_lite.nodes.surroundings import Surroundings, View
from move_base_lite.parameters import settings_from_parameters
from move_base_lite.planning import headings_along
from move_base_lite.warming import warm_up
from planar import Pose2, SettingsError, Twist2
from planar_ros.clock import sleep_until
from planar_ros.messages import OccupancyGridArrays, frame_name, grid_from_msg
from planar_ros.parameters import parameters_below
from planar_ros.progress import Progress
from planar_ros.shell import run
from planar_ros.transforms import Transforms
from planar_ros.waiting import Waiting

WARN_SECONDS = 5.0
FEEDBACK_PERIOD = rospy.Duration(0.2)
INACTIVE_TEXT = "move_base must be in an inactive state to make a plan for an external user"
KILLED_TEXT = "Aborting on the goal because the node has been killed"


class MoveBaseNode:
    """Callbacks store; one thread ticks the Navigator in ROS time and publishes what it decides."""

    def __init__(self):
        parameters = parameters_below("~")
        self._settings, warnings = settings_from_parameters(parameters, rospy.get_name() + "/")
        for warning in warnings:
            if warning.startswith("unknown parameter") and parameters.get("strict_params", False):
                raise SettingsError(warning)
            rospy.logwarn(warning)
        warm_up(self._settings)
        self._map_frame = frame_name(self._settings.global_costmap.global_frame)
        self._odom_frame = frame_name(self._settings.local_costmap.global_frame)
        self._lock = threading.RLock()
        self._new_map: Optional[OccupancyGridArrays] = None
        self._navigator: Optional[Navigator] = None
        self._view: Optional[View] = None
        self._goal = Pose2()
        self._lost_since = rospy.Time(0)
        self._next_feedback = rospy.Time(0)
        self._advertise(parameters)
        self._transforms = Transforms()
        odom_topic = parameters.get("DWAPlannerROS", {}).get("odom_topic", "odom")
        self._surroundings = Surroundings(self._settings, self._transforms, odom_topic)
        self._progress = Progress()
        self._await_inputs()
        self._server.start()
        rospy.on_shutdown(self._on_shutdown)
        self._thread = threading.Thread(target=self._control, daemon=True)
        self._thread.start()

    def _advertise(self, parameters):
        planner = str(parameters.get("base_global_planner", "navfn/NavfnROS")).rpartition("/")[2]
        self._command = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        self._current_goal = rospy.Publisher("~current_goal", PoseStamped, queue_size=1)
        self._outcome = rospy.Publisher("~outcome", DiagnosticStatus, queue_size=1, latch=True)
        self._feedback = rospy.Publisher("~nav_feedback", DiagnosticStatus, queue_size=1)
        self._recovery = rospy.Publisher("move_base/recovery_status", RecoveryStatus, queue_size=1)
        self._action_goal = rospy.Publisher("move_base/goal", MoveBaseActionGoal, queue_size=1)
        self._plan = rospy.Publisher(f"~{planner}/plan", Path, queue_size=1)
        self._global_plan = rospy.Publisher("~DWAPlannerROS/global_plan", Path, queue_size=1)
        self._local_plan = rospy.Publisher("~DWAPlannerROS/local_plan", Path, queue_size=1)
        self._global_topics = CostmapTopics("global_costmap")
        self._local_topics = CostmapTopics("local_costmap")
        self._server = SimpleActionServer("move_base", MoveBaseAction, auto_start=False)
        rospy.Subscriber("move_base_simple/goal", PoseStamped, self._on_simple_goal, queue_size=1)
        rospy.Service("~make_plan", GetPlan, self._on_make_plan)
        rospy.Service("~clear_costmaps", Empty, self._on_clear_costmaps)

    def _await_inputs(self):
        conditions = {
            f"the transforms {self._map_frame} -> {self._odom_frame} -> "
            f"{frame_name(self._settings.local_costmap.robot_base_frame)}": lambda: self._view is not None,
        }
        for topic in self._surroundings.topics:
            heard = f"a message on {topic}"
            conditions[heard] = lambda topic=topic: topic not in self._surroundings.silent_topics
        static = self._settings.global_costmap.static
        if static.enabled:
            conditions[f"a map on {rospy.resolve_name(static.map_topic)}"] = self._has_map
            rospy.Subscriber(static.map_topic, OccupancyGridArrays, self._on_map, queue_size=1)
        else:
            self._navigator = Navigator(self._settings)
        Waiting(conditions)

    def _has_map(self) -> bool:
        return self._new_map is not None or self._navigator is not None

    def _on_map(self, message):
        self._new_map = message

    def _on_simple_goal(self, message):
        goal = MoveBaseActionGoal()
        goal.header.stamp = rospy.Time.now()
        goal.goal.target_pose = message
        self._action_goal.publish(goal)

    def _on_make_plan(self, request):
        with self._lock:
            if self._server.is_active():
                raise rospy.ServiceException(INACTIVE_TEXT)
            if self._navigator is None:
                raise rospy.ServiceException("move_base has no map yet")
            start = self._start_of(request.start)
            try:
                goal = goal_from_msg(request.goal, self._map_frame, self._transforms)
                path_xy = self._plan_for(start, goal, request.tolerance)
            except NavigationError as error:
                rospy.logwarn("make_plan: %s", error)
                return GetPlanResponse()
        response = GetPlanResponse()
        response.plan.poses = self._plan_msg(path_xy, rospy.Time.now(), start.yaw, goal.yaw).poses
        return response

    def _start_of(self, message) -> Pose2:
        if message.header.frame_id:
            return goal_from_msg(message, self._map_frame, self._transforms)
        if self._view is None:
            raise rospy.ServiceException("move_base cannot make a plan: the robot's pose is not known")
        return self._view.base_in_map

    def _plan_for(self, start: Pose2, goal: Pose2, tolerance: float) -> np.ndarray:
        settings = self._settings.move_base
        if settings.make_plan_clear_costmap and self._view is not None:
            self._navigator.clear_around(self._view.base_in_map)
        path_xy = self._navigator.make_plan(start, goal, tolerance)
        goal_xy = np.array([[goal.x, goal.y]])
        if settings.make_plan_add_unreachable_goal and not np.allclose(path_xy[-1], goal_xy):
            path_xy = np.concatenate((path_xy, goal_xy))
        return path_xy

    def _on_clear_costmaps(self, request):
        with self._lock:
            if self._navigator is not None:
                self._navigator.clear_costmaps()
        return EmptyResponse()

    def _control(self):
        """Ticks in ROS time; a jump back of time starts afresh."""
        period = rospy.Duration(1.0 / self._settings.move_base.controller_frequency)
        due = rospy.Time(0)
        while not rospy.is_shutdown():
            try:
                if due - rospy.Time.now() > 2 * period:
                    raise rospy.ROSTimeMovedBackwardsException((due - rospy.Time.now()).to_sec())
                now = sleep_until(due)
                self._tick(now)
                self._progress.report(now)
                due = max(due + period, now) if due != rospy.Time(0) else now + period
            except rospy.ROSTimeMovedBackwardsException:
                due = rospy.Time(0)
                self._start_afresh()
            except rospy.ROSInterruptException:
                return

    def _start_afresh(self):
        rospy.logwarn("time has jumped back: forgetting goal, obstacles and transforms")
        with self._lock:
            self._surroundings.forget()
            self._next_feedback = rospy.Time(0)
            self._global_topics.forget_time()
            self._local_topics.forget_time()
            if self._navigator is not None:
                self._navigator.forget()
            if self._server.is_active():
                self._server.set_aborted(text="Aborting on the goal because time has jumped back")
                self._command.publish(Twist())

    def _tick(self, now: rospy.Time):
        with self._lock:
            self._take_map()
            if self._navigator is None:
                return
            view = self._surroundings.view(now)
            if view is None:
                self._stand_still(now)
                return
            self._view, self._lost_since = view, now
            self._take_goal(now)
            decision = self._navigator.tick(
                now.to_sec(), view.base_in_map, view.base_in_odom, view.twist, None, view.sightings
            )
            self._act(now, decision)
            self._global_topics.publish(now, self._navigator.global_costmap, view.base_in_map)
            self._local_topics.publish(now, self._navigator.local_costmap, view.base_in_odom)

    def _take_map(self):
        message, self._new_map = self._new_map, None
        if message is None:
            return
        grid = grid_from_msg(message)
        if self._navigator is None:
            self._navigator = Navigator(self._settings, grid)
            rospy.loginfo("odom received, map received: ready for goals")
        else:
            self._navigator.set_map(grid)

    def _stand_still(self, now: rospy.Time):
        """Without transforms nothing is safe but standing; goals still come, are cancelled and given up."""
        missing = f"waiting for {self._surroundings.missing_transform(now)}"
        rospy.logwarn_throttle(WARN_SECONDS, missing)
        self._take_goal(now)
        if not self._server.is_active():
            self._lost_since = now
            return
        self._command.publish(Twist())
        if self._server.is_preempt_requested():
            self._navigator.forget_goal()
            self._outcome.publish(outcome_msg(Outcome(CANCELLED_OUTCOME, "CANCELLED", "")))
            self._server.set_preempted()
        elif (now - self._lost_since).to_sec() > self._settings.move_base.sensor_patience:
            lost = RobotLost(missing)
            self._refuse(with_reason(Trigger.CONTROLLING.value, lost), lost)

    def _take_goal(self, now: rospy.Time):
        """Accepts a new goal, which preempts the old one, or hears that the present one is cancelled."""
        with self._server.action_server.lock, self._server.lock:
            is_new = self._server.is_new_goal_available()
            if not is_new:
                if self._server.is_active() and self._server.is_preempt_requested():
                    self._navigator.cancel()
                return
            message = self._server.accept_new_goal().target_pose
        try:
            self._goal = goal_from_msg(message, self._map_frame, self._transforms)
        except InvalidGoal as error:
            self._refuse(str(error), error)
        except NavigationError as error:
            self._refuse(with_reason(Trigger.PLANNING.value, error), error)
        else:
            self._navigator.set_goal(self._goal)
            self._current_goal.publish(pose_msg(self._goal, now, self._map_frame))

    def _refuse(self, text: str, error: NavigationError):
        rospy.logerr(text)
        self._outcome.publish(outcome_msg(Outcome(error.outcome, error.code, text)))
        self._navigator.forget_goal()
        self._command.publish(Twist())
        self._server.set_aborted(text=text)

    def _act(self, now: rospy.Time, decision: Decision):
        if decision.command is not None:
            self._command.publish(_twist_msg(decision.command))
        self._publish_plans(now, decision)
        if decision.recovery is not None:
            self._tell_recovery(now, decision)
        if self._server.is_active():
            feedback = MoveBaseFeedback(pose_msg(self._view.base_in_map, now, self._map_frame))
            self._server.publish_feedback(feedback)
        if decision.progress is not None and now >= self._next_feedback:
            self._next_feedback = now + FEEDBACK_PERIOD
            self._feedback.publish(progress_msg(decision))
        if decision.outcome is not None:
            self._outcome.publish(outcome_msg(decision.outcome))
        if decision.status is Status.SUCCEEDED:
            self._server.set_succeeded(text=decision.text)
        elif decision.status is Status.ABORTED:
            rospy.logerr(decision.text)
            self._server.set_aborted(text=decision.text)
        elif decision.status is Status.CANCELLED:
            self._server.set_preempted()
        elif decision.text:
            rospy.logwarn_throttle(WARN_SECONDS, decision.text)

    def _publish_plans(self, now: rospy.Time, decision: Decision):
        if decision.plan_xy is not None and self._plan.get_num_connections():
            start_yaw = self._view.base_in_map.yaw
            self._plan.publish(self._plan_msg(decision.plan_xy, now, start_yaw, self._goal.yaw))
        if decision.followed_xy is not None and self._global_plan.get_num_connections():
            level = np.zeros(len(decision.followed_xy))
            self._global_plan.publish(path_msg(decision.followed_xy, now, self._odom_frame, level))
        if decision.trajectory is not None and self._local_plan.get_num_connections():
            self._local_plan.publish(trajectory_msg(decision.trajectory, now, self._odom_frame))

    def _plan_msg(self, path_xy: np.ndarray, now: rospy.Time, start_yaw: float, goal_yaw: float) -> Path:
        mode = self._settings.planner.orientation_mode
        return path_msg(path_xy, now, self._map_frame, headings_along(path_xy, mode, start_yaw, goal_yaw))

    def _tell_recovery(self, now: rospy.Time, decision: Decision):
        recovery = decision.recovery
        rospy.logwarn("recovery behavior %s (%d of %d)", recovery.name, recovery.index + 1, recovery.total)
        pose = pose_msg(self._view.base_in_map, now, self._map_frame)
        self._recovery.publish(RecoveryStatus(pose, recovery.index, recovery.total, recovery.name))

    def _on_shutdown(self):
        with self._lock:
            if self._server.is_active():
                self._command.publish(Twist())
                self._server.set_aborted(text=KILLED_TEXT)


def _twist_msg(command: Twist2) -> Twist:
    message = Twist()
    message.linear.x, message.angular.z = command.v, command.omega
    return message


def main():
    run("move_base", MoveBaseNode)
