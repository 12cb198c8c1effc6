#!/usr/bin/env python3
from planar_ros.node.entry import call

call("teleop_lite.ros.twist_keyboard:main")
