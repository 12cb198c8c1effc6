#!/usr/bin/env python3
"""Run nodes of other people beside a mission, twice; print the rule of each and how far its messages repeat.

python3 tests/benchmarks/other_nodes.py [--seed 102] [--busy 2] [--json FILE]

The mission is that of home_service.launch with the nodes of this project, which are in lock-step; all other
nodes are paced by their rules. With ``--busy``, so many busy processes run beside the second run. The nodes
must be where rospack finds them; those that are not there are left out.
"""

import argparse
import hashlib
import json
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, List, Tuple

import rospkg
from helpers.recorded_launch import join_graph, recorded_launch
from unsynchronised_nodes import OVER, ROOT

from sim_bridge.ros.timing.stamped_messages import HEADER, stamp_of

HOME = ROOT / "map"
# Simulated time from which messages are compared [s]: until then nodes start, in an order that differs.
FIRST_STAMP = 5.0
LAUNCH = """<launch>
  <include file="$(find home_service)/launch/home_service.launch">
    <arg name="world_file" value="{home}/home.world"/>
    <arg name="map_file" value="{home}/home.yaml"/>
    <arg name="zones_file" value="{home}/zones.yaml"/>
    <arg name="seed" value="{seed}"/>
    <arg name="speed" value="0"/>
  </include>
  <param name="/sim_bridge/pace_all" value="true"/>
  <param name="/sim_bridge/bystanders" value="recorder"/>
  {nodes}
</launch>
"""
COSTMAP = """<rosparam ns="costmap">
      {global_frame: map, robot_base_frame: base_footprint, width: 6, height: 6, rolling_window: true,
       update_frequency: 5, publish_frequency: 2, always_send_full_costmap: true, robot_radius: 0.2}
    </rosparam>"""
# Name of the node: package, program, arguments, what its element holds, topic that is compared.
NODES: Dict[str, Tuple[str, str, str, str, str]] = {
    "other_amcl": (
        "amcl",
        "amcl",
        "",
        '<param name="tf_broadcast" value="false"/><remap from="amcl_pose" to="other_amcl/pose"/>'
        '<remap from="particlecloud" to="other_amcl/particlecloud"/>'
        '<remap from="global_localization" to="other_amcl/global_localization"/>'
        '<remap from="request_nomotion_update" to="other_amcl/request_nomotion_update"/>'
        '<remap from="set_map" to="other_amcl/set_map"/>',
        "/other_amcl/particlecloud",
    ),
    "other_map_server": (
        "map_server",
        "map_server",
        f"{HOME}/home.yaml",
        '<remap from="map" to="other_map_server/map"/>'
        '<remap from="static_map" to="other_map_server/static_map"/>'
        '<remap from="map_metadata" to="other_map_server/map_metadata"/>'
        '<remap from="change_map" to="other_map_server/change_map"/>',
        "/other_map_server/map",
    ),
    "costmap_node": ("costmap_2d", "costmap_2d_node", "", COSTMAP, "/costmap_node/costmap/costmap"),
    "relay": ("topic_tools", "relay", "scan relay/scan", "", "/relay/scan"),
    "throttle": ("topic_tools", "throttle", "messages scan 3 throttle/scan", "", "/throttle/scan"),
    "drop": ("topic_tools", "drop", "scan 1 2 drop/scan", "", "/drop/scan"),
    "static_tf": ("tf2_ros", "static_transform_publisher", "0 0 1 0 0 0 odom lamp", "", "/tf_static"),
    "old_static_tf": ("tf", "static_transform_publisher", "0 0 1 0 0 0 odom shelf 100", "", "/tf"),
    "robot_pose_publisher": (
        "robot_pose_publisher",
        "robot_pose_publisher",
        "",
        '<param name="base_frame" value="base_footprint"/><param name="is_stamped" value="true"/>',
        "/robot_pose",
    ),
    "mux": ("topic_tools", "mux", "mux/scan scan relay/scan", "", "/mux/scan"),
}


@dataclass
class Recording:
    """What a run sent.

    Attributes:
        messages: Stamp [s], or number without a stamp, and digest of each message, by topic.
        rules: Rule of each node, in words.
        wall_seconds: Wall time of the mission.
        simulated_seconds: Simulated time of the mission.
    """

    messages: Dict[str, List[Tuple[float, str]]] = field(default_factory=dict)
    rules: List[str] = field(default_factory=list)
    wall_seconds: float = 0.0
    simulated_seconds: float = 0.0


def run_mission(seed: int, busy: int, log: Path) -> Recording:
    """Run the mission with the nodes beside it, and record it."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "other_nodes.launch"
        nodes = "\n  ".join(_element(name) for name in installed())
        file.write_text(LAUNCH.format(home=HOME, seed=seed, nodes=nodes))
        recording: Recording = recorded_launch([str(file)], _record, (), busy, log)
        return recording


def installed() -> List[str]:
    """Return the names of the nodes whose packages are there."""
    packages = set(rospkg.RosPack().list())
    return [name for name, (package, *_) in NODES.items() if package in packages]


def _element(name: str) -> str:
    package, program, arguments, content, _ = NODES[name]
    return f'<node name="{name}" pkg="{package}" type="{program}" args="{arguments}">{content}</node>'


def _record(master: str, results: Any) -> None:
    import rospy
    from std_msgs.msg import String

    join_graph(master)
    recording, begun = Recording(), time.monotonic()

    def on_message(message: Any, topic: str) -> None:
        header = message._connection_header
        if topic.startswith("/tf") and "static_tf" not in header.get("callerid", ""):
            return
        data, kept = message._buff, recording.messages.setdefault(topic, [])
        stamp = stamp_of(data, header.get("message_definition", ""))
        start = 0 if stamp is None else HEADER.size
        kept.append((float(len(kept)) if stamp is None else stamp, hashlib.sha256(data[start:]).hexdigest()))

    def on_state(message: Any) -> None:
        if message.data in OVER:
            recording.wall_seconds = time.monotonic() - begun
            recording.simulated_seconds = rospy.get_time()
            results.put(recording)

    def on_rules(message: Any) -> None:
        recording.rules = message.data.splitlines()

    for name in installed():
        rospy.Subscriber(NODES[name][-1], rospy.AnyMsg, on_message, NODES[name][-1], tcp_nodelay=True)
    rospy.Subscriber("/simulation/pace", String, on_rules)
    rospy.Subscriber("pick_objects/state", String, on_state)
    while True:
        time.sleep(1.0)


def compared(first: List[Tuple[float, str]], second: List[Tuple[float, str]]) -> Dict[str, Any]:
    """Compare what two runs sent on a topic: number of messages at common stamps, how many are equal."""
    before, after = dict(first), dict(second)
    end = min(max(before, default=0.0), max(after, default=0.0))
    stamps = {stamp for stamp in {*before, *after} if FIRST_STAMP <= stamp <= end} or {*before, *after}
    different = sorted(stamp for stamp in stamps if before.get(stamp) != after.get(stamp))
    return {
        "messages": len(stamps),
        "equal": len(stamps) - len(different),
        "differ_from": different[0] if different else None,
    }


def main() -> int:
    options = _options()
    runs = [run_mission(options.seed, busy, options.log) for busy in (0, options.busy)]
    rows = []
    for name in installed():
        topic = NODES[name][-1]
        row = compared(*(run.messages.get(topic, []) for run in runs))
        rule = next((line for line in runs[0].rules if line.startswith(f"{name}: ")), f"{name}: no rule")
        rows.append({"node": name, "topic": topic, **row, "rule": rule})
        print(f"{row['equal']:5} of {row['messages']:5} equal, differ from {row['differ_from']}  {rule}")
    for run in runs:
        print(f"{run.simulated_seconds:.1f} s simulated in {run.wall_seconds:.1f} s")
    if options.json:
        options.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=102, help="default: 102")
    parser.add_argument(
        "--busy", type=int, default=0, help="busy processes beside the second run (default: 0)"
    )
    parser.add_argument("--log", type=Path, default=Path("other_nodes.log"), help="output of the nodes")
    parser.add_argument("--json", type=Path, help="also write the table here")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
