"""Consumers of run events: judge, recorder, trace, figures. No ROS."""
