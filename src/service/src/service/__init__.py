"""Requests to a home-service robot: queue, schedule, execution, journal. No ROS outside of ``service.ros``."""
