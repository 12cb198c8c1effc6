"""Diagnosis of a running ROS graph."""
