"""view_frames of tf, which draws the tree of frames into frames.pdf; Debian's program fails with Python 3."""

import argparse
import shutil
import subprocess
import sys
import time
from pathlib import Path

import rospy
import tf
from tf.srv import FrameGraph

LISTEN_SECONDS = 5.0  # s, as tf's


def main() -> None:
    """Exit code 1 if the node does not respond or graphviz is not installed."""
    parser = argparse.ArgumentParser(
        prog="view_frames", description="Draw the tree of frames into frames.pdf."
    )
    parser.add_argument("--node", help="node whose frames are drawn (default: the frames on /tf)")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("view_frames", anonymous=True)
    try:
        graph = _graph_of(options.node) if options.node else _graph_of_tf()
    except (rospy.ROSException, rospy.ServiceException) as error:
        sys.exit(f"error: {options.node} provides no service tf_frames: {error}")
    Path("frames.gv").write_text(graph)
    if shutil.which("dot") is None:
        sys.exit("error: graphviz is not installed; the tree is in frames.gv")
    subprocess.run(["dot", "-Tpdf", "frames.gv", "-o", "frames.pdf"], check=True)
    print("frames.pdf generated")


def _graph_of_tf() -> str:
    """The frames on /tf in the DOT language."""
    print(f"Listening to /tf for {LISTEN_SECONDS} seconds")
    listener = tf.TransformListener()
    time.sleep(LISTEN_SECONDS)
    print("Done Listening")
    return str(listener.allFramesAsDot(rospy.Time.now()))


def _graph_of(node: str) -> str:
    service = f"{node}/tf_frames"
    print(f"Waiting for service {service}")
    rospy.wait_for_service(service, timeout=LISTEN_SECONDS)
    return str(rospy.ServiceProxy(service, FrameGraph)().dot_graph)
