"""Snapshot of a running graph: master and nodes are queried, topics are measured for a while."""

import os
import time
from typing import Callable, Dict, List, Optional

import psutil
import rosgraph
import rospy
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from home_service.doctor.diagnosis import GraphSnapshot, NodeState, TopicState
from planar_ros.messages.conversion import frame_name
from planar_ros.node.readiness import WAITING_FOR_TOPIC as WAITING_TOPIC
from planar_ros.node.runner import init_node
from supervision.ros.node_api import answers
from supervision.versions import versions

MEASURED_TOPICS = ("/clock", "/scan", "/odom", "/joint_states", "/tf", "/cmd_vel")
SILENT_WHILE_IDLE = ("/cmd_vel",)


def inspect_graph(master: Optional[str], seconds: float) -> GraphSnapshot:
    """Take a snapshot of a graph.

    Args:
        master: URI of its master; None: the newest one on this machine.
        seconds: Time for which topics are measured [s].
    """
    snapshot = GraphSnapshot(versions=versions())
    masters = [master] if master else running_masters()
    if masters:
        snapshot.master, snapshot.other_masters = masters[0], masters[1:]
        _inspect(snapshot, masters[0], seconds)
    return snapshot


def running_masters() -> List[str]:
    """Return URIs of responding masters: ROS_MASTER_URI first, then those of this machine, newest first."""
    found = [os.environ.get("ROS_MASTER_URI", "")]
    for process in sorted(
        psutil.process_iter(["cmdline", "create_time"]), key=lambda p: -p.info["create_time"]
    ):
        command = process.info["cmdline"] or []
        if any(part.endswith("rosmaster") for part in command) and "-p" in command:
            found.append(f"http://127.0.0.1:{command[command.index('-p') + 1]}")
    return [uri for uri in dict.fromkeys(found) if uri and answers(uri)]


def _inspect(snapshot: GraphSnapshot, uri: str, seconds: float) -> None:
    os.environ["ROS_MASTER_URI"] = uri
    init_node("doctor", anonymous=True, log_level=rospy.FATAL)
    myself, master = rospy.get_name(), rosgraph.Master(rospy.get_name(), uri)
    snapshot.uses_simulated_time = bool(rospy.get_param("/use_sim_time", False))
    publishers, subscribers, services = map(dict, master.getSystemState())
    everybody = [
        name for part in (publishers, subscribers, services) for names in part.values() for name in names
    ]
    addresses = {name: _address(master, name) for name in sorted({*everybody} - {myself})}
    snapshot.nodes = [
        NodeState(name, is_alive=answers(uri)) for name, uri in addresses.items() if uri is not None
    ]
    snapshot.topics = [
        TopicState(name, sorted(publishers.get(name, [])), sorted({*subscribers.get(name, [])} - {myself}))
        for name in sorted({*publishers, *subscribers})
    ]
    TopicMonitor(snapshot).measure(seconds)
    rospy.signal_shutdown("examined")


def _address(master: rosgraph.Master, node: str) -> Optional[str]:
    """Return the URI of a node; None if it has exited."""
    try:
        return master.lookupNode(node)
    except rosgraph.MasterError:
        return None


class TopicMonitor:
    """Adds rates, time, frames and what nodes wait for to a snapshot."""

    def __init__(self, snapshot: GraphSnapshot):
        self._findings = snapshot
        self._counts: Dict[str, int] = {}
        self._stamps: List[float] = []
        self._handlers = {"/clock": (Clock, self._on_clock), "/tf": (TFMessage, self._on_frames)}

    def measure(self, seconds: float) -> None:
        """Subscribe and measure for so many seconds."""
        snapshot = self._findings
        measured = [topic for topic in snapshot.topics if topic.name in MEASURED_TOPICS]
        for topic in measured:
            kind, handle = self._handlers.get(topic.name, (rospy.AnyMsg, lambda _message: None))
            rospy.Subscriber(topic.name, kind, self._counted(topic.name, handle), tcp_nodelay=True)
        rospy.Subscriber("/tf_static", TFMessage, self._on_frames)
        for node in snapshot.nodes:
            rospy.Subscriber(f"{node.name}/{WAITING_TOPIC}", String, self._on_waiting, node)
        time.sleep(seconds)
        simulated = self._stamps[-1] - self._stamps[0] if len(self._stamps) > 1 else 0.0
        clock = snapshot.topic("/clock")
        if clock is not None and clock.publishers:
            snapshot.real_time_factor = simulated / seconds
        elapsed = simulated if snapshot.uses_simulated_time and simulated else seconds
        for topic in measured:
            rate = self._counts.get(topic.name, 0) / elapsed
            topic.rate = None if not rate and topic.name in SILENT_WHILE_IDLE else rate

    def _counted(self, name: str, handle: Callable[[object], None]) -> Callable[[object], None]:
        def callback(message):
            self._counts[name] = self._counts.get(name, 0) + 1
            handle(message)

        return callback

    def _on_clock(self, message):
        self._stamps.append(message.clock.to_sec())

    def _on_frames(self, message):
        for transform in message.transforms:
            child, parent = frame_name(transform.child_frame_id), frame_name(transform.header.frame_id)
            self._findings.parents.setdefault(child, set()).add(parent)

    @staticmethod
    def _on_waiting(message, node):
        node.waits_for = message.data.splitlines()
