"""ROS interface of pick_objects."""
