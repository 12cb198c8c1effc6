#!/usr/bin/env python3
from planar_ros.node.entry import call

call("turtle_world.ros.tf_demo:follow")
