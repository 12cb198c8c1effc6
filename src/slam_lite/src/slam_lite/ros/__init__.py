"""ROS adapters of slam_lite: messages in, values to the core, messages out."""
