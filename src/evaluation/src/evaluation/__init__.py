"""Judgement of runs by ground truth. No ROS."""
