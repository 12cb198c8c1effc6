"""The ROS side of this package: messages in, values to the core, messages out."""
