"""Requests to a robot: queue, schedule, execution, journal. No ROS outside of ``service.ros``."""
